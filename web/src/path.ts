// The path: a slider over its steps, the response curve with its events, and the events as a table.

import { chart, extent, inside, onResize, path, widen } from './chart';
import { h, s } from './dom';
import type { PathEvent, Result, Step, TracePoint } from './result';
import type { Store } from './store';
import { quiet, type Kind, type Units } from './units';
import { eventName } from './words';

type Quantity = 'rod_length' | 'axial_force_end' | 'torque_end' | 'contacts';
const quantities: { name: Quantity; title: string; kind: Kind }[] = [
  { name: 'rod_length', title: 'Rod length', kind: 'length' },
  { name: 'axial_force_end', title: 'Axial force at the end', kind: 'force' },
  { name: 'torque_end', title: 'Torque at the end', kind: 'moment' },
  { name: 'contacts', title: 'Number of contacts', kind: 'none' },
];

const ofStep = (step: Step, name: Quantity) => (name === 'contacts' ? step.contacts.length : step[name]);
const ofTrace = (point: TracePoint, name: Quantity) => point[name];
const ofEvent = (event: PathEvent, name: Quantity) => (name === 'rod_length' || name === 'axial_force_end' ? event[name] : null);

export class PathView {
  readonly element = h('div');
  private readonly figure = h('div', { class: 'figure' });
  private readonly slider: HTMLInputElement;
  private readonly told = h('output', { class: 'told' });
  private quantity: Quantity;

  constructor(
    private readonly store: Store,
    private readonly units: Units,
  ) {
    const { result } = store;
    this.quantity = this.varies(result, 'rod_length') ? 'rod_length' : 'axial_force_end';
    this.slider = h('input', { type: 'range', min: 0, max: Math.max(result.steps.length - 1, 0), step: 1, id: 'step-slider', 'aria-label': 'Step of the path' });
    this.slider.addEventListener('input', () => store.setStep(Number(this.slider.value)));
    const select = h(
      'select',
      { 'aria-label': 'Quantity of the response curve' },
      ...quantities.filter((q) => this.varies(result, q.name)).map((q) => h('option', { value: q.name, selected: q.name === this.quantity }, q.title)),
    );
    select.addEventListener('change', () => {
      this.quantity = select.value as Quantity;
      this.build();
    });
    this.element.append(
      h('div', { class: 'controls' }, h('label', { class: 'grow' }, 'Step', this.slider), this.told, h('label', {}, 'Show', select)),
      this.figure,
      this.events(result),
    );
    store.listen((what) => what === 'step' && this.build());
    onResize(this.figure, () => this.build());
  }

  private varies(result: Result, name: Quantity): boolean {
    const [low, high] = extent([...result.trace.map((t) => ofTrace(t, name)), ...result.steps.map((step) => ofStep(step, name))]);
    return high - low > 1e-9 * Math.max(Math.abs(high), Math.abs(low));
  }

  private build(): void {
    const { store, units } = this;
    const { result } = store;
    this.slider.value = String(store.step);
    const now = store.current;
    this.told.textContent = now ? `${store.step + 1} of ${result.steps.length}: ${units.parameterText(now.parameter)}` : 'no step was reached';
    this.slider.setAttribute('aria-valuetext', this.told.textContent);
    const q = quantities.find((other) => other.name === this.quantity)!;
    const trace = result.trace.length ? result.trace : null;
    const of = units.of(q.kind);
    const [x0, x1] = widen(extent([...(trace ?? []).map((t) => t.parameter), ...result.steps.map((step) => step.parameter), ...result.events.map((e) => e.parameter)]), 0.03);
    const [y0, y1] = widen(extent([...(trace ?? []).map((t) => ofTrace(t, q.name)), ...result.steps.map((step) => ofStep(step, q.name)), ...result.events.map((e) => ofEvent(e, q.name))]), 0.08);
    const c = chart(
      this.figure,
      300,
      { low: x0, high: x1, factor: units.of(units.parameter.kind).factor, label: units.parameter.heading },
      { low: y0, high: y1, factor: of.factor, label: units.heading(q.title, q.kind) },
      `Response: ${q.title} against ${units.parameter.name}`,
    );
    if (trace) c.plot.append(s('path', { class: 'response', d: path(trace.map((t) => [c.x(t.parameter), c.y(ofTrace(t, q.name) ?? NaN)])) }));
    else c.plot.append(s('path', { class: 'response dashed', d: path(result.steps.map((step) => [c.x(step.parameter ?? NaN), c.y(ofStep(step, q.name) ?? NaN)])) }));
    result.events.forEach((event, i) => {
      const value = ofEvent(event, q.name);
      const x = c.x(event.parameter);
      const title = s('title', {}, `${i + 1}: ${eventName(event.kind)}, ${units.parameterText(event.parameter)}`);
      if (value === null) c.plot.append(s('line', { class: 'event-line', x1: x, x2: x, y1: c.y(y0), y2: c.y(y1) }, title));
      else {
        const y = c.y(value);
        c.over.append(s('path', { class: 'event', d: `M${x} ${y - 6}L${x + 6} ${y}L${x} ${y + 6}L${x - 6} ${y}Z` }, title), s('text', { class: 'event-name', x: x + 9, y: y - 7 }, String(i + 1)));
      }
    });
    result.steps.forEach((step, i) => {
      const value = ofStep(step, q.name);
      if (step.parameter === null || value === null) return;
      const kind = step.status === 'converged' ? 'step' : 'step failed';
      c.over.append(
        s('circle', { class: i === store.step ? `${kind} now` : kind, cx: c.x(step.parameter), cy: c.y(value), r: i === store.step ? 7 : result.steps.length > 60 ? 2.5 : 4.5 }, s('title', {}, `step ${i + 1}: ${units.parameterText(step.parameter)}`)),
      );
    });
    c.svg.addEventListener('click', (event) => {
      const [px, py] = inside(c.svg, event);
      let best = -1;
      let near = 400;
      result.steps.forEach((step, i) => {
        const d = (c.x(step.parameter ?? NaN) - px) ** 2 + (c.y(ofStep(step, q.name) ?? NaN) - py) ** 2;
        if (d < near) [best, near] = [i, d];
      });
      if (best >= 0) store.setStep(best);
    });
    this.figure.replaceChildren(c.svg);
  }

  private events(result: Result): HTMLElement {
    if (!result.events.length) return h('p', { class: 'quiet' }, 'No event on the path.');
    const { units } = this;
    const force = Math.max(0, ...result.steps.flatMap((step) => [Math.abs(step.axial_force_end ?? 0), ...step.contacts.map((c) => c.force)]));
    return h(
      'div',
      { class: 'scroll' },
      h(
        'table',
        { class: 'numbers', id: 'events' },
        h('caption', { class: 'hidden' }, 'Events on the path, in the order met'),
        h('thead', {}, h('tr', {}, ...['', 'Event', units.parameter.heading, units.heading('S', 'length'), units.heading('Rod length', 'length'), units.heading('F₃ at the end', 'force')].map((t, i) => h('th', { scope: 'col', class: i === 1 ? 'text' : '' }, t)))),
        h(
          'tbody',
          {},
          ...result.events.map((e, i) =>
            h(
              'tr',
              {},
              h('td', { class: 'index' }, String(i + 1)),
              h('td', { class: 'text' }, eventName(e.kind)),
              cell(e.parameter, units.number(e.parameter, units.parameter.kind, 8)),
              cell(e.S, units.number(e.S, 'length')),
              cell(e.rod_length, units.number(e.rod_length, 'length')),
              cell(e.axial_force_end, units.number(quiet(e.axial_force_end, force), 'force')),
            ),
          ),
        ),
      ),
    );
  }
}

/** A number of the file, as shown; the value itself stays with it. */
export function cell(value: number | null, shown: string): HTMLTableCellElement {
  return h('td', { 'data-value': String(value), title: value === null ? null : String(value) }, shown);
}
