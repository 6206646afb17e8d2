// The emitted page in a browser: it asks for nothing, reports no error, draws, answers pointer and keys, and every number
// on it is the result file's.

import assert from 'node:assert/strict';
import fs from 'node:fs';

import { colours, launch, needs, open, same, solved, tendril } from './_page.mjs';
import { syntheticWell } from './synthetic_well.mjs';

needs();

const columns = ['gap', 'pressure', 'F3', 'F1', 'F2', 'M1', 'M2', 'M3', 'kappa'];
const value = (page, selector) => page.$eval(selector, (e) => e.dataset.value);
const text = (page, selector) => page.$eval(selector, (e) => e.textContent);
const readouts = (page) => page.$$eval('.track .values [data-field]', (all) => Object.fromEntries(all.map((e) => [e.dataset.field, e.dataset.value])));

// What the page holds is the file, without the solver's states.
function holds(file, result) {
  const html = fs.readFileSync(file, 'utf8');
  assert.ok(html.length < 5e6, `${file}: ${html.length} bytes`);
  const from = html.indexOf('id="tendril-result">') + 'id="tendril-result">'.length;
  const data = JSON.parse(html.slice(from, html.indexOf('</script>', from)));
  const expected = structuredClone(result);
  for (const step of expected.steps) delete step.state;
  assert.equal(data.page.thinned, null);
  same(data.result, expected, 'result');
}

// Key numbers, contacts, certificate of a step, as shown.
async function numbers(page, step) {
  for (const name of ['rod_length', 'axial_force_start', 'axial_force_end', 'push', 'torque_start', 'torque_end', 'stability'])
    assert.equal(await value(page, `#key-numbers [data-key=${name}]`), String(step[name]), name);
  const rows = await page.$$eval('#contacts-table tbody tr', (all) => all.map((row) => [...row.querySelectorAll('[data-value]')].map((e) => e.dataset.value)));
  assert.equal(rows.length, step.contacts.length);
  step.contacts.forEach((c, i) => {
    const shown = c.kind === 'point' ? [c.start, c.angle_start, c.force] : [c.start, c.end, c.angle_start, c.angle_end, c.force, c.force_start, c.force_end, c.force_distributed, c.pressure_min, c.pressure_max];
    assert.deepEqual(rows[i], shown.map(String), `contact ${i + 1}`);
  });
  const certificate = await page.$$eval('#certificate-table tbody tr', (all) => all.map((row) => [row.querySelector('code').textContent, row.querySelector('[data-value]').dataset.value]));
  same(Object.fromEntries(certificate), Object.fromEntries(Object.entries(step.certificate).map(([k, v]) => [k, String(v)])), 'certificate');
}

// The arrays behind the tracks are the columns of the file.
async function tracks(page, step) {
  const plotted = await page.evaluate(() => {
    const { tracks } = tendrilReport;
    return [...tracks.plots].map(([id, plot]) => [id, plot.data.map((column) => [...column])]);
  });
  const expected = { gap: ['gap'], pressure: ['pressure'], axial: ['F3'], shear: ['F1', 'F2'], bending: ['M1', 'M2'], twisting: ['M3'], curvature: ['kappa'] };
  assert.deepEqual(plotted.map(([id]) => id), Object.keys(expected));
  for (const [id, data] of plotted) ['S', ...expected[id]].forEach((name, k) => same(data[k], step.fields[name], `${id}.${name}`));
}

async function shows(page, step, row) {
  const shown = await readouts(page);
  for (const name of columns) assert.equal(shown[name], String(step.fields[name][row]), `${name} at row ${row}`);
}

// The marker stands on every track, at the row's place.
async function marked(page, step, row, upright) {
  const S = step.fields.S;
  const share = (S[row] - S[0]) / (S.at(-1) - S[0]);
  const lines = await page.$$eval('.track .u-cursor-x', (all) => all.map((e) => [e.getBoundingClientRect(), e.parentElement.getBoundingClientRect()].map((b) => b.toJSON())));
  assert.equal(lines.length, 7);
  for (const [line, over] of lines) {
    const at = upright ? (line.bottom - over.top) / over.height : (line.right - over.left) / over.width;
    assert.ok(line.width > 0 && line.height > 0 && Math.abs(at - share) < 0.01, `marker at ${at} of the track, not ${share}`);
  }
}

async function pointer(page, step, upright = false) {
  const S = step.fields.S;
  await marked(page, step, await page.evaluate(() => tendrilReport.store.row), upright);
  // a track moves the marker in the picture ...
  const over = await page.$('[data-track=shear] .u-over');
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  for (const share of [0.23, 0.61]) {
    if (upright) await page.mouse.move(box.x + 0.5 * box.width, box.y + share * box.height);
    else await page.mouse.move(box.x + share * box.width, box.y + 0.5 * box.height);
    await page.waitForTimeout(120);
    const row = await page.evaluate(() => tendrilReport.store.row);
    const at = S[0] + share * (S[S.length - 1] - S[0]);
    const off = Math.min(...S.map((v) => Math.abs(v - at)));
    assert.ok(Math.abs(S[row] - at) <= off + (2 * (S[S.length - 1] - S[0])) / (upright ? box.height : box.width), `marker at ${S[row]}, pointer at ${at}`);
    await shows(page, step, row);
    await marked(page, step, row, upright);
  }
  // dragging along the places zooms, a double click shows all
  const [x0, y0] = [box.x + 0.4 * box.width, box.y + 0.4 * box.height];
  await page.mouse.move(x0, y0);
  await page.mouse.down();
  await page.mouse.move(x0 + (upright ? 0 : 0.2 * box.width), y0 + (upright ? 0.2 * box.height : 0), { steps: 4 });
  await page.mouse.up();
  const range = () => page.evaluate(() => [...tendrilReport.tracks.plots.values()].map((plot) => [plot.scales.x.min, plot.scales.x.max]));
  const length = S.at(-1) - S[0];
  for (const [min, max] of await range()) {
    assert.ok(Math.abs(min - (S[0] + 0.4 * length)) < 0.02 * length && Math.abs(max - (S[0] + 0.6 * length)) < 0.02 * length, `zoomed to ${min} .. ${max}`);
  }
  await page.mouse.dblclick(x0, y0);
  for (const [min, max] of await range()) assert.deepEqual([min, max], [S[0], S.at(-1)]);
  // ... and the picture moves the marker on the tracks
  await (await page.$('.scene')).scrollIntoViewIfNeeded();
  const scene = await (await page.$('.scene')).boundingBox();
  const target = Math.round(0.8 * (S.length - 1));
  const [x, y] = await page.evaluate((row) => tendrilReport.pixelOf(row), target);
  await page.mouse.move(scene.x + x, scene.y + y);
  await page.waitForTimeout(120);
  const row = await page.evaluate(() => tendrilReport.store.row);
  const [rx, ry] = await page.evaluate((r) => tendrilReport.pixelOf(r), row);
  assert.ok(Math.hypot(rx - x, ry - y) < 3, `pointed at row ${target}, marker at row ${row}`);
  await shows(page, step, row);
}

async function keyboard(page, result) {
  const last = result.steps.length - 1;
  const step = result.steps[last];
  const row = () => page.evaluate(() => tendrilReport.store.row);
  await page.focus('.tracks');
  await page.keyboard.press('Home');
  assert.equal(await row(), 0);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Shift+ArrowRight');
  assert.equal(await row(), 11);
  await page.keyboard.press('PageDown');
  const first = step.contacts[0];
  const place = step.fields.S[await row()];
  assert.ok(Math.abs(place - 0.5 * (first.start + first.end)) < 0.01 * step.fields.S.at(-1), `first contact, at ${place}`);
  await page.waitForTimeout(120);
  await shows(page, step, await row());
  assert.equal(await page.$eval('.tracks', (e) => e.getAttribute('aria-valuenow')), String(place));
  await page.keyboard.press('End');
  assert.equal(await row(), step.fields.S.length - 1);
  const picture = await page.$('.scene');
  const before = (await picture.screenshot()).toString('base64');
  await picture.focus();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('+');
  await page.waitForTimeout(300);
  assert.notEqual((await picture.screenshot()).toString('base64'), before, 'arrow keys turn the picture');
  if (last > 0) {
    await page.keyboard.press('[');
    assert.equal(await page.evaluate(() => tendrilReport.store.step), last - 1);
    await numbers(page, result.steps[last - 1]);
    await tracks(page, result.steps[last - 1]);
    assert.equal(await page.$eval('#step-slider', (e) => e.value), String(last - 1));
    await page.focus('#step-slider');
    await page.keyboard.press('Home');
    await numbers(page, result.steps[0]);
    await page.keyboard.press('End');
  }
}

async function path(page, result) {
  const rows = await page.$$eval('#events tbody tr', (all) => all.map((row) => [...row.querySelectorAll('[data-value]')].map((e) => e.dataset.value)));
  assert.deepEqual(rows, result.events.map((e) => [e.parameter, e.S, e.rod_length, e.axial_force_end].map(String)));
  assert.equal(await page.$$eval('#path .event, #path .event-line', (all) => all.length), result.events.length);
  assert.equal(await page.$$eval('#path circle.step', (all) => all.length), result.steps.length);
}

async function drawn(page) {
  const frame = await page.evaluate(() => tendrilReport.drawn());
  assert.ok(frame.calls > 3 && frame.triangles > 1000, JSON.stringify(frame));
  const [scene] = await colours(page, '.scene canvas');
  assert.ok(scene > 100, `${scene} colours in the picture`);
  const plots = await colours(page, '.track canvas');
  assert.equal(plots.length, 7);
  for (const count of plots) assert.ok(count > 4, `${plots} colours in the tracks`);
}

const order = ['verdict', 'key-numbers', 'warnings', 'rod', 'tracks', 'path', 'wall', 'contacts', 'certificate', 'inputs', 'provenance'];
async function inOrder(page, withPath) {
  const ids = await page.$$eval('main [id]', (all) => all.map((e) => e.id));
  assert.deepEqual(ids.filter((id) => order.includes(id)), order.filter((id) => withPath || id !== 'path'));
}

const browser = await launch();
for (const example of ['helix_outer_20', 'guidewire_vessel', 'well_forge', 'outside_winding']) {
  const { page: file, result } = solved(example);
  holds(file, result);
  const { page, faults, milliseconds } = await open(browser, file);
  const step = result.steps.at(-1);
  await inOrder(page, result.steps.length > 1);
  await numbers(page, step);
  await tracks(page, step);
  await drawn(page);
  const upright = example === 'well_forge'; // a survey: depth downwards
  assert.equal(await page.$eval('.tracks', (e) => e.classList.contains('upright')), upright);
  await pointer(page, step, upright);
  if (result.events.length) await path(page, result);
  await keyboard(page, result);
  assert.deepEqual(faults, [], example);
  console.log(`${example}: ${(fs.statSync(file).size / 1e6).toFixed(2)} MB, open after ${milliseconds} ms; ${await text(page, '#verdict')}`);
  await page.close();
}

{
  // words of the verdict against the file
  const { page } = await open(browser, `${process.cwd()}/guidewire_vessel.html`);
  assert.match(await text(page, '#verdict'), /^1 point contact; force 0\.1276\sN at 73\.08\smm; stable; certified to /);
  // the centreline's file is in mm: told, under its own name
  assert.equal(await text(page, '#warnings'), 'data/synthetic_vessel.csv: lengths converted from mm to m.');
  // print: controls are gone, everything else is there, on a few pages
  await page.emulateMedia({ media: 'print' });
  assert.equal(await page.$eval('.choice', (e) => getComputedStyle(e).display), 'none');
  const pdf = (await page.pdf({ format: 'A4' })).toString('latin1');
  const sheets = pdf.match(/\/Type \/Page\b(?!s)/g).length;
  assert.ok(sheets >= 2 && sheets <= 5, `${sheets} sheets of paper`);
  await page.close();
}

{
  // depth downwards or not, as one likes; the places zoomed to stay
  const { page, faults } = await open(browser, `${process.cwd()}/well_forge.html`);
  const step = JSON.parse(fs.readFileSync('well_forge.json', 'utf8')).steps[0];
  for (const upright of [false, true]) {
    await page.click('text=Depth downwards');
    await page.waitForTimeout(200);
    await pointer(page, step, upright);
  }
  const [wide, shown] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert.ok(wide <= shown, `${wide} pixels wide`);
  assert.deepEqual(faults, []);
  await page.close();
}

{
  // dark, narrow: no sideways scrolling
  const { page, faults } = await open(browser, `${process.cwd()}/helix_outer_20.html`, { viewport: { width: 400, height: 800 }, colorScheme: 'dark' });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 400, `${wide} pixels wide`);
  assert.ok(parseInt((await page.evaluate(() => getComputedStyle(document.body).backgroundColor)).slice(4)) < 60, 'dark paper');
  assert.deepEqual(faults, []);
  await page.close();
}

{
  // a long well: opens, scrolls to its end, all rows there
  fs.writeFileSync('well.json', JSON.stringify(syntheticWell(1000)));
  tendril('report', 'well.json', '-o', 'well.html');
  holds('well.html', JSON.parse(fs.readFileSync('well.json', 'utf8')));
  const { page, faults, milliseconds, readable } = await open(browser, `${process.cwd()}/well.html`);
  assert.match(await text(page, '#verdict'), /^1000 contacts: 800 points, 200 lines of 400\sm in all; largest force 1\.\d+\skN/);
  await page.waitForFunction(() => document.querySelectorAll('#contacts-table tbody tr').length === 1000);
  await page.mouse.move(40, 500);
  await page.mouse.wheel(0, 600);
  await page.waitForFunction(() => scrollY > 300);
  await page.evaluate(() => scrollTo({ top: 1e6, behavior: 'instant' }));
  const foot = await (await page.$('footer')).boundingBox();
  assert.ok(foot.y < 900, 'the end of the page comes into view');
  await drawn(page);
  assert.deepEqual(faults, []);
  console.log(`1000 contacts: ${(fs.statSync('well.html').size / 1e6).toFixed(2)} MB, readable after ${readable} ms, open with its picture after ${milliseconds} ms`);
  await page.close();
}

{
  // a long path does not fit: thinned, and says so; contacts stay complete
  const loads = Array.from({ length: 90 }, (_, i) => -8 - i);
  const { page: file, result } = solved('helix_outer_20', '--set', `path.values=[${loads}]`);
  assert.ok(fs.statSync(file).size <= 5e6, `${fs.statSync(file).size} bytes`);
  const { page, faults } = await open(browser, file);
  assert.match(await text(page, '#warnings'), /To keep this page small it holds \d+ of \d+ rows along the rod/);
  await numbers(page, result.steps.at(-1));
  const S = await page.evaluate(() => [...tendrilReport.tracks.plots.get('gap').data[0]]);
  const all = new Set(result.steps.at(-1).fields.S);
  assert.ok(S.length > 100 && S.length < all.size && S.every((v) => all.has(v)), `${S.length} of ${all.size} rows`);
  assert.deepEqual(faults, []);
  await page.close();
}

{
  // without fields, and with a title that tries to break out
  const title = '</script><script>alert(1)</script><!-- "quoted" \\\\';
  const json = `${process.cwd()}/bare.json`;
  tendril('run', `${process.env.TENDRIL_SOURCE_DIR}/examples/guidewire_vessel.toml`, '--quiet', '--json', json, '--set', `title='${title}'`);
  tendril('report', json, '-o', 'bare.html');
  const { page, faults } = await open(browser, `${process.cwd()}/bare.html`);
  assert.equal(await text(page, 'h1'), title);
  assert.match(await text(page, '#warnings'), /no fields along the rod/);
  await numbers(page, JSON.parse(fs.readFileSync(json, 'utf8')).steps[0]);
  assert.deepEqual(faults, []);
  await page.close();
}

{
  // results that stopped early: no step at all; numbers missing along the rod and in the certificate; no tube, no inputs
  const whole = JSON.parse(fs.readFileSync('well_forge.json', 'utf8'));
  const stumps = {
    empty: { ...whole, steps: [], interrupted: true, status: 'not_converged', message: 'stopped' },
    holes: structuredClone(whole),
    bare: { ...structuredClone(whole), case: {}, tube: undefined },
  };
  const step = stumps.holes.steps[0];
  for (const [name, column] of Object.entries(step.fields)) if (name !== 'S') column.fill(null, 20, 90);
  for (const name of Object.keys(step.certificate)) step.certificate[name] = null;
  step.contacts[0].force = null;
  for (const [name, result] of Object.entries(stumps)) {
    fs.writeFileSync(`${name}.json`, JSON.stringify(result));
    tendril('report', `${name}.json`, '-o', `${name}.html`);
    const { page, faults } = await open(browser, `${process.cwd()}/${name}.html`);
    if (name === 'empty') {
      assert.equal(await text(page, '#verdict'), 'Not solved: no state was found.');
      assert.match(await text(page, '#warnings'), /interrupted/);
    } else {
      await numbers(page, result.steps[0]);
      await tracks(page, result.steps[0]);
    }
    assert.deepEqual(faults, [], name);
    await page.close();
  }
}
await browser.close();

{
  // without WebGL: flat views, everything else the same
  const blind = await launch('--disable-3d-apis');
  const result = JSON.parse(fs.readFileSync('well_forge.json', 'utf8'));
  const { page, faults } = await open(blind, `${process.cwd()}/well_forge.html`);
  const step = result.steps.at(-1);
  assert.equal(await page.$$eval('.flat-views svg', (all) => all.length), 2);
  const lines = await page.$$eval('.flat-views svg:first-child path[stroke]', (all) => all.length);
  assert.ok(lines >= step.contacts.filter((c) => c.kind === 'line').length, `${lines} line contacts drawn`);
  assert.match(await text(page, '.picture'), /no WebGL/);
  await numbers(page, step);
  await tracks(page, step);
  for (const count of await colours(page, '.track canvas')) assert.ok(count > 4);
  assert.deepEqual(faults, []);
  await blind.close();
}
console.log('report: all good');
