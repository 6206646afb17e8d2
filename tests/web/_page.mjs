// Shared by the tests of the report: the program, the browser, and what must never happen on a page.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

export const source = process.env.TENDRIL_SOURCE_DIR;
const skipped = 77; // ctest counts this exit code as skipped

export function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(skipped);
}

function browserProgram() {
  const names = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
  return names.find((name) => name && fs.existsSync(name));
}

export function needs() {
  if (!process.env.TENDRIL_PAGE) skip('this build has no report page (no Node 18 with npm when it was configured)');
  if (!fs.existsSync(path.join(source, 'web', 'node_modules', 'playwright-core'))) skip('web/node_modules has no playwright-core (npm ci in web/ installs it)');
  if (!browserProgram()) skip('there is no Chromium here (tools/setup.sh tests installs it); or name one in CHROMIUM');
}

export const tendril = (...parameters) =>
  execFileSync(process.env.TENDRIL, parameters.map(String), { stdio: ['ignore', 'pipe', 'pipe'], encoding: 'utf8', maxBuffer: 1 << 28 });

/** Solve an example into NAME.json and NAME.html, in the same run. */
export function solved(example, ...more) {
  const page = path.resolve(`${example}.html`);
  const json = path.resolve(`${example}.json`);
  tendril('run', path.join(source, 'examples', `${example}.toml`), '--quiet', '--fields', '--json', json, '--report', page, ...more);
  return { page, result: JSON.parse(fs.readFileSync(json, 'utf8')) };
}

export async function launch(...more) {
  const { chromium } = createRequire(path.join(source, 'web', 'package.json'))('playwright-core');
  const quiet = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
  return chromium.launch({ executablePath: browserProgram(), args: [...quiet, ...more] });
}

// Chromium's software rendering remarks that reading pixels is slow; that is no fault of the page.
const remark = /GPU stall due to ReadPixels/;

/** Open an emitted file. `faults` collects errors, warnings and every request but the file's own. */
export async function open(browser, file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1360, height: 900 }, ...options });
  page.setDefaultTimeout(180_000); // a loaded machine without a graphics card is slow, not wrong
  const faults = [];
  const url = `file://${file}`;
  page.on('console', (m) => ['error', 'warning'].includes(m.type()) && !remark.test(m.text()) && faults.push(`console ${m.type()}: ${m.text()}`));
  page.on('pageerror', (error) => faults.push(`error: ${error.message}`));
  page.on('dialog', (dialog) => (faults.push('a dialog opened'), dialog.dismiss()));
  page.on('request', (r) => r.url() !== url && !r.url().startsWith('data:') && faults.push(`request: ${r.url()}`));
  const began = Date.now();
  await page.goto(url);
  await page.waitForFunction(() => document.documentElement.dataset.ready);
  const milliseconds = Date.now() - began;
  const readable = await page.evaluate(() => Math.round(performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN));
  return { page, faults, milliseconds, readable };
}

/** Bit for bit; a missing key on either side is a difference too. */
export function same(actual, expected, where = '') {
  if (expected !== null && typeof expected === 'object') {
    assert.ok(actual !== null && typeof actual === 'object', where);
    assert.deepEqual(Object.keys(actual).sort(), Object.keys(expected).sort(), where);
    for (const key of Object.keys(expected)) same(actual[key], expected[key], `${where}.${key}`);
  } else {
    assert.ok(Object.is(actual, expected), `${where}: ${actual} is not ${expected}`);
  }
}

/** Different colours on the canvases that match; a blank one has one. */
export const colours = (page, selector) =>
  page.evaluate((wanted) => {
    return [...document.querySelectorAll(wanted)].map((canvas) => {
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext('2d');
      context.drawImage(canvas, 0, 0);
      const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
      return new Set(pixels).size;
    });
  }, selector);
