// The page of a result, in the order in which it is read. Nothing is computed here but where to draw.

import 'uplot/dist/uPlot.min.css';
import './style.css';

import { h, section } from './dom';
import { Geometry } from './geometry';
import { PathView } from './path';
import { reached, readPage } from './result';
import { Scene, type Wall } from './scene';
import { Store } from './store';
import { certificate, contactTable, inputs, provenance } from './tables';
import { forceGradient, nextTheme } from './theme';
import { Tracks } from './tracks';
import { format, quiet, Units, type Kind } from './units';
import { FlatViews } from './views';
import { WallMap } from './wallmap';
import { verdict, warnings } from './words';

const data = readPage();
const { result } = data;
const units = new Units(result);
const store = new Store(result);
const geometry = result.tube && result.tube.S.length > 1 ? new Geometry(result.tube, result) : null;
const title = String(result.case?.title || result.case?.file || 'A rod in its tube');
document.title = `${title} – Tendril`;

function header(): HTMLElement {
  const line = h('p', { class: 'verdict', id: 'verdict' });
  const build = () => {
    line.textContent = verdict(store.current, units);
  };
  store.listen((what) => what === 'step' && build());
  build();
  const theme = h('button', { class: 'plain', type: 'button', title: 'Light or dark', 'aria-label': 'Light or dark' }, '◐');
  theme.addEventListener('click', () => {
    nextTheme();
    store.look();
  });
  return h('header', {}, h('div', { class: 'overline' }, h('span', {}, 'Tendril report'), theme), h('h1', {}, title), line);
}

function keyNumbers(): HTMLElement {
  const host = h('dl', { class: 'key-numbers', id: 'key-numbers' });
  const build = () => {
    const step = store.current;
    host.hidden = !reached(step);
    if (!reached(step)) return host.replaceChildren();
    const forces = [step.axial_force_start, step.axial_force_end, step.push, ...step.contacts.map((c) => c.force)];
    const force = Math.max(...forces.map((v) => Math.abs(v ?? 0)));
    const moment = force * Math.abs(step.rod_length ?? 0);
    const most = step.contacts.reduce<number | null>((m, c) => (m === null || c.force > m ? c.force : m), null);
    const rows: [string, string, number | null, Kind, number][] = [
      ['rod_length', 'Rod length', step.rod_length, 'length', 0],
      ['axial_force_start', 'Axial force F₃, start', step.axial_force_start, 'force', force],
      ['axial_force_end', 'Axial force F₃, end', step.axial_force_end, 'force', force],
      ['push', 'Push', step.push, 'force', force],
      ['torque_start', 'Torque M₃, start', step.torque_start, 'moment', moment],
      ['torque_end', 'Torque M₃, end', step.torque_end, 'moment', moment],
      ['largest', 'Largest contact force', most, 'force', 0],
    ];
    const tile = (name: string, label: string, shown: string, unit: string, value: number | null | string) =>
      h('div', { 'data-key': name, 'data-value': String(value) }, h('dt', {}, label), h('dd', { title: String(value) }, shown, unit ? h('small', {}, unit) : null));
    host.replaceChildren(
      ...rows.map(([name, label, value, kind, scale]) => tile(name, label, units.number(quiet(value, scale), kind, 5), value === null ? '' : units.of(kind).label, value)),
      tile('stability', 'Stability', step.stability, '', step.stability),
    );
  };
  store.listen((what) => what === 'step' && build());
  build();
  return host;
}

function warningList(): HTMLElement {
  const host = h('ul', { class: 'warnings', id: 'warnings', 'aria-label': 'Warnings' });
  const build = () => {
    const list = warnings(data, store.current, units);
    host.replaceChildren(
      ...(list.length ? list.map((w) => h('li', { class: w.level }, w.text)) : [h('li', { class: 'none' }, 'No warnings.')]),
    );
  };
  store.listen((what) => what === 'step' && build());
  build();
  return host;
}

function stepBar(): HTMLElement | null {
  if (result.steps.length < 2) return null;
  const told = h('span', { class: 'told' });
  const move = (by: number, label: string, text: string) => h('button', { type: 'button', 'aria-label': label, onclick: () => store.setStep(store.step + by) }, text);
  const build = () => {
    told.replaceChildren(h('b', {}, `Step ${store.step + 1}`), ` of ${result.steps.length}`, h('span', { class: 'quiet' }, ` ${units.parameterText(store.current?.parameter ?? null)}`));
  };
  store.listen((what) => what === 'step' && build());
  build();
  return h('div', { class: 'step-bar', role: 'group', 'aria-label': 'Step of the path' }, move(-1, 'Previous step', '‹'), told, move(1, 'Next step', '›'));
}

let scene: Scene | null = null;
const kWide = 1040; // pixels: as in the style sheet
const kPrintWidth = 680; // pixels: A4 less its margins

function picture(): HTMLElement {
  if (!geometry) return h('p', { class: 'empty' }, 'This result has no tube to draw; write it with --fields.');
  const host = h('div', { class: 'scene', tabindex: 0, role: 'application', 'aria-label': 'The rod in its tube; arrow keys turn, plus and minus zoom, 0 shows all' });
  const { start, most } = geometry.factors();
  let views: FlatViews | null = null;
  try {
    scene = new Scene(host, geometry, store, (v) => `S = ${units.text(v, 'length')}`);
  } catch {
    host.removeAttribute('role');
    host.removeAttribute('tabindex');
    host.classList.add('without-webgl');
    views = new FlatViews(geometry, store);
    host.append(views.element);
  }
  const apply = (factor: number) => {
    told.textContent = factor === 1 ? 'true scale' : `radius × ${format(factor, 2)}`;
    slider.setAttribute('aria-valuetext', told.textContent);
    scene?.setFactor(factor);
    views?.setFactor(factor);
  };
  // The slider is logarithmic and ends where the drawn tube would overlap itself or lose its shape.
  const slider = h('input', { type: 'range', min: 0, max: 1, step: 0.005, value: most > 1 ? Math.log(start) / Math.log(most) : 0, id: 'exaggeration', 'aria-label': 'Exaggeration of the radius', disabled: most <= 1 });
  const told = h('output', { for: 'exaggeration', class: 'told' }, start === 1 ? 'true scale' : `radius × ${format(start, 2)}`);
  slider.addEventListener('input', () => apply(Math.max(1, most ** Number(slider.value))));
  const trueScale = h('button', { type: 'button', onclick: () => ((slider.value = '0'), apply(1)) }, 'True scale');
  const walls: [Wall, string][] = [['translucent', 'Translucent'], ['cut', 'Cut open'], ['none', 'No wall']];
  const wallChoice = h(
    'fieldset',
    { class: 'choice' },
    h('legend', { class: 'hidden' }, 'Wall of the tube'),
    ...walls.map(([value, text], i) => h('label', {}, h('input', { type: 'radio', name: 'wall', value, checked: i === 0, onchange: () => scene?.setWall(value) }), h('span', {}, text))),
  );
  const reset = h('button', { type: 'button', onclick: () => scene?.home() }, 'Whole tube');
  const most3 = h('span');
  const legend = h('div', { class: 'legend' }, h('span', {}, 'Contact force 0'), h('i', { style: `background:${forceGradient}` }), most3);
  const build = () => {
    const largest = Math.max(0, ...(store.current?.contacts ?? []).map((c) => c.force));
    most3.textContent = units.text(largest, 'force');
    legend.hidden = largest === 0;
  };
  store.listen((what) => what === 'step' && build());
  build();
  return h(
    'div',
    { class: 'picture' },
    host,
    h('div', { class: 'controls' }, scene ? wallChoice : null, scene ? reset : null, legend),
    h('div', { class: 'controls' }, h('label', { class: 'grow' }, 'Radius', slider), told, trueScale),
    h('p', { class: 'quiet hint' }, 'Arrows are the concentrated reactions of the wall on the rod, sheets its pressure along a line contact. ', scene ? 'Drag to turn; click, then the wheel zooms; point at the rod to read the tracks there.' : 'There is no WebGL here: flat views instead of the scene.'),
  );
}

function main(): void {
  const page = document.getElementById('page')!;
  // Wells are read from the top down, wherever the page is wide enough for the tracks side by side.
  const well = result.case?.tube?.axis?.kind === 'survey';
  const tracks = new Tracks(store, units, well && innerWidth >= kWide);
  const linked = h('div', { class: 'linked' });
  const turn = (upright: boolean) => {
    linked.classList.toggle('upright', upright);
    tracks.setUpright(upright);
  };
  linked.classList.toggle('upright', tracks.element.classList.contains('upright'));
  const upright = h('input', { type: 'checkbox', checked: linked.classList.contains('upright'), onchange: () => turn((upright as HTMLInputElement).checked) });
  const length = result.tube?.S[result.tube.S.length - 1] ?? result.case?.resolved?.axis_length ?? 1;
  linked.append(
    section('rod', geometry?.sign === -1 ? 'The rod around its core' : 'The rod in its tube', picture()),
    section(
      'tracks',
      'Along the tube',
      tracks.element,
      h('p', { class: 'quiet hint' }, 'Shaded: line contact; dashed: point contact. Drag across a track to zoom, double-click to see all.'),
      h('div', { class: 'controls' }, h('label', {}, upright, 'Depth downwards')),
    ),
  );
  page.replaceChildren(
    header(),
    keyNumbers(),
    warningList(),
    ...[stepBar()].filter((e): e is HTMLElement => !!e),
    linked,
    ...(result.steps.length > 1 || result.trace.length > 1 ? [section('path', 'Path', new PathView(store, units).element)] : []),
    section('wall', 'The wall unrolled', new WallMap(store, units, length).element),
    section('contacts', 'Contacts', contactTable(store, units)),
    section('certificate', 'Certificate', certificate(store)),
    section('inputs', 'Inputs', inputs(data)),
    section('provenance', 'Provenance', provenance(data, store)),
    h(
      'footer',
      {},
      h('p', {}, 'Lengths S run along the axis of the tube from its start. F₁, F₂, M₁, M₂ in the rod’s section, F₃ and M₃ along it; tension positive. Forces of contacts are magnitudes, pressure is per unit length of the axis. Frictionless contact, rigid wall.'),
      h('p', {}, 'Keys: ← → move the marker (with Shift in tens), Page Up and Page Down go from contact to contact, Home and End to the ends, Esc shows the whole length; in the picture arrows turn, + − zoom, 0 shows all; [ and ] change the step.'),
    ),
  );
  document.addEventListener('keydown', (event) => {
    if (event.key === '[') store.setStep(store.step - 1);
    if (event.key === ']') store.setStep(store.step + 1);
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => store.look());
  addEventListener('beforeprint', () => {
    document.documentElement.classList.add('printing');
    turn(false);
    tracks.fixedWidth = kPrintWidth;
    tracks.resize();
    store.look();
    scene?.printAt(kPrintWidth);
  });
  addEventListener('afterprint', () => {
    document.documentElement.classList.remove('printing');
    tracks.fixedWidth = 0;
    turn((upright as HTMLInputElement).checked);
    tracks.resize();
    store.look();
    scene?.afterPrint();
  });
  // For tests of the page: what is drawn, not how.
  Object.assign(window, { tendrilReport: { store, tracks, drawn: () => scene?.drawn ?? null, pixelOf: (row: number) => scene?.pixelOf(row) ?? null } });
  // Ready when the picture, which comes a moment after the rest, is drawn.
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  void frame()
    .then(() => new Promise((done) => setTimeout(done)))
    .then(frame)
    .then(frame)
    .then(() => (document.documentElement.dataset.ready = 'true'));
}

main();
