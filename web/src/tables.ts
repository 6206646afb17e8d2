// Contacts, certificate, inputs and provenance.

import { h } from './dom';
import { cell } from './path';
import { middle, reached, type Contact, type PageData } from './result';
import type { Store } from './store';
import { forceColour } from './theme';
import { format, quiet, type Kind, type Units } from './units';

const contactColumns: [keyof Contact, string, Kind][] = [
  ['start', 'from S', 'length'],
  ['end', 'to S', 'length'],
  ['angle_start', 'β', 'angle'],
  ['angle_end', 'to β', 'angle'],
  ['force', 'force', 'force'],
  ['force_start', 'at start', 'force'],
  ['force_end', 'at end', 'force'],
  ['force_distributed', 'between', 'force'],
  ['pressure_min', 'p min', 'pressure'],
  ['pressure_max', 'p max', 'pressure'],
];

const kAtOnce = 60; // rows before the page is first shown

export function contactTable(store: Store, units: Units): HTMLElement {
  const host = h('div', { class: 'scroll' });
  const build = () => {
    const contacts = store.current?.contacts ?? [];
    if (!contacts.length) {
      host.replaceChildren(h('p', { class: 'quiet' }, reached(store.current) ? 'The rod touches the wall nowhere.' : 'There is no state.'));
      return;
    }
    const most = Math.max(...contacts.map((c) => c.force));
    const onlyOfLines = new Set(['end', 'angle_end']);
    const row = (c: Contact, i: number) =>
      h(
        'tr',
        { tabindex: 0, onclick: () => store.setPlace(middle(c)), onkeydown: (event: KeyboardEvent) => event.key === 'Enter' && store.setPlace(middle(c)) },
        h('td', { class: 'index' }, String(i + 1)),
        h('td', { class: 'text' }, h('i', { class: 'swatch', style: `background:${forceColour(most > 0 ? c.force / most : 0)}` }), c.kind),
        ...contactColumns.map(([name, , kind]) => {
          const value = c[name] as number | null;
          return c.kind !== 'line' && (onlyOfLines.has(name) || value === null) ? h('td') : cell(value, units.number(kind === 'angle' ? quiet(value, 1) : value, kind));
        }),
      );
    const body = h('tbody', {}, ...contacts.slice(0, kAtOnce).map(row));
    const titles = contactColumns.map(([, title, kind]) => h('th', { scope: 'col' }, units.heading(title, kind)));
    host.replaceChildren(
      h(
        'table',
        { class: 'numbers', id: 'contacts-table' },
        h('caption', { class: 'hidden' }, 'Contacts in order along the tube'),
        h('thead', {}, h('tr', {}, h('th', {}, ''), h('th', { scope: 'col', class: 'text' }, 'Kind'), ...titles)),
        body,
      ),
    );
    const rest = () => body.isConnected && body.append(...contacts.slice(kAtOnce).map((c, i) => row(c, i + kAtOnce)));
    if (contacts.length > kAtOnce) setTimeout(rest, 0);
  };
  store.listen((what) => what !== 'row' && build());
  build();
  return host;
}

// Each figure, what it is, and what it is held against (docs/notation.md).
const figures: [string, string, string, (v: number) => boolean][] = [
  ['equilibrium', 'largest residual of the equations of equilibrium, between the nodes', 'vanishes', (v) => v < 1e-6],
  ['error', 'estimated relative error of all unknowns, between the nodes', 'vanishes', (v) => v < 1e-6],
  ['balance', 'force and moment of the whole rod: ends, weight and wall together', 'vanishes', (v) => v < 1e-6],
  ['continuity', 'largest jump of place, force or moment at a junction', 'vanishes', (v) => v < 1e-6],
  ['invariant_spread', 'spread of the first integrals H and M₃ (weightless rods)', 'vanishes', (v) => v < 1e-6],
  ['phase_multiplier', 'force that holds a rod which may turn about the axis', 'vanishes', (v) => Math.abs(v) < 1e-6],
  ['gap_min', 'smallest gap on free segments, over the clearance', '≥ 0', (v) => v > -1e-6],
  ['reaction_min', 'smallest reaction or pressure, scaled; pushing is positive', '≥ 0', (v) => v > -1e-6],
  ['curvature_max', 'curvature at point contacts beyond what the wall allows', '≤ 0', (v) => v < 1e-6],
  ['strain_max', 'largest stretch of the rod', 'small', (v) => v < 0.01],
];

export function certificate(store: Store): HTMLElement {
  const host = h('div', { class: 'scroll' });
  const build = () => {
    const step = store.current;
    if (!reached(step)) return host.replaceChildren(h('p', { class: 'quiet' }, 'There is no state to certify.'));
    return host.replaceChildren(
      h(
        'table',
        { class: 'numbers wide', id: 'certificate-table' },
        h('thead', {}, h('tr', {}, h('th', { class: 'text' }, 'Figure'), h('th', { class: 'text' }, 'What it says'), h('th', {}, 'Value'), h('th', { class: 'text' }, 'Should be'), h('th', {}, ''))),
        h(
          'tbody',
          {},
          ...figures.map(([name, what, should, good]) => {
            const value = step.certificate[name] ?? null;
            const verdict = value === null ? '' : good(value) ? '✓' : '!';
            return h(
              'tr',
              {},
              h('td', { class: 'text' }, h('code', {}, name)),
              h('td', { class: 'text' }, what),
              cell(value, value === null ? '–' : format(value, 2)),
              h('td', { class: 'text' }, should),
              h('td', { class: verdict === '!' ? 'bad' : 'good', 'aria-label': verdict === '✓' ? 'holds' : verdict === '!' ? 'does not hold' : '' }, verdict),
            );
          }),
        ),
      ),
      h('p', { class: 'quiet' }, 'Computed anew from the solved state; nothing is taken from the solver. All figures are dimensionless.'),
    );
  };
  store.listen((what) => what === 'step' && build());
  build();
  return host;
}

function tree(value: unknown): HTMLElement {
  if (value && typeof value === 'object' && !Array.isArray(value)) {
    return h('dl', {}, ...Object.entries(value).flatMap(([key, item]) => [h('dt', {}, key), h('dd', {}, tree(item))]));
  }
  if (Array.isArray(value)) {
    const text = JSON.stringify(value).replace(/,/g, ', ');
    return text.length < 220 ? h('span', {}, text) : h('details', {}, h('summary', {}, `${value.length} values`), h('span', {}, text));
  }
  return h('span', {}, value === null ? 'none' : String(value));
}

export function inputs(data: PageData): HTMLElement {
  const { resolved, file, ...given } = data.result.case ?? {};
  void file;
  return h('div', { class: 'inputs' }, h('div', {}, h('h3', {}, 'As given'), tree(given)), h('div', {}, h('h3', {}, 'What follows from it'), tree(resolved ?? {})));
}

export function provenance(data: PageData, store: Store): HTMLElement {
  const { result, page } = data;
  const host = h('dl', { class: 'provenance' });
  const build = () => {
    const step = store.current;
    const sum = (name: string) => result.steps.reduce((total, other) => total + (other.effort?.[name] ?? 0), 0);
    const rows: [string, string][] = [
      ['Solved by', `Tendril ${result.tendril}`],
      ['Page made by', `Tendril ${page.tendril}`],
      ['Case file', String(result.case?.file ?? '–')],
      ['Result format', String(result.result_schema)],
      ['Branch', step?.branch || '–'],
      ['Effort', `${sum('newton_iterations')} Newton iterations, ${sum('patterns_tried')} contact patterns tried, ${format(sum('wall_seconds'), 3)} s`],
    ];
    host.replaceChildren(...rows.flatMap(([name, text]) => [h('dt', {}, name), h('dd', {}, text)]));
  };
  store.listen((what) => what === 'step' && build());
  build();
  return host;
}
