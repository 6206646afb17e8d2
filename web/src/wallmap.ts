// The wall unrolled: where along the tube (S) and around it (β, from D1 towards D2) the rod touches.

import { chart, inside, onResize, path, type Chart } from './chart';
import { h, s } from './dom';
import { hasFields } from './result';
import type { Store } from './store';
import { forceColour } from './theme';
import type { Units } from './units';

const turn = 2 * Math.PI;
const wrapped = (angle: number) => angle - turn * Math.round(angle / turn);

export class WallMap {
  readonly element = h('div', { class: 'figure' });
  private here: SVGElement | null = null;
  private chart: Chart | null = null;

  constructor(
    private readonly store: Store,
    private readonly units: Units,
    private readonly length: number,
  ) {
    store.listen((what) => (what === 'row' ? this.mark() : this.build()));
    this.element.addEventListener('pointermove', (event) => {
      if (this.chart) store.setPlace(this.chart.toX(inside(this.chart.svg, event)[0]));
    });
    onResize(this.element, () => this.build());
  }

  private build(): void {
    const step = this.store.current;
    const factor = 180 / Math.PI;
    const c = (this.chart = chart(
      this.element,
      260,
      { low: 0, high: this.length, factor: this.units.of('length').factor, label: this.units.place },
      { low: -Math.PI, high: Math.PI, factor, label: 'β around it [°]', ticks: [-180, -90, 0, 90, 180] },
      'Contacts on the unrolled wall of the tube',
    ));
    if (step && hasFields(step)) {
      const f = step.fields!;
      const points: ([number, number] | null)[] = [];
      let before: number | null = null;
      const size = f.delta1.reduce<number>((m, v, i) => Math.max(m, Math.hypot(v ?? 0, f.delta2[i] ?? 0)), 0);
      f.S.forEach((S, i) => {
        const [a, b] = [f.delta1[i] ?? NaN, f.delta2[i] ?? NaN];
        if (!(Math.hypot(a, b) > 1e-3 * size)) {
          before = null;
          return points.push(null);
        }
        const beta = Math.atan2(b, a);
        if (before !== null && Math.abs(beta - before) > Math.PI) points.push(null);
        before = beta;
        return points.push([c.x(S!), c.y(beta)]);
      });
      c.plot.append(s('path', { class: 'trace', d: path(points) }));
    }
    const contacts = step?.contacts ?? [];
    const most = Math.max(0, ...contacts.map((k) => k.force));
    for (const k of contacts) {
      const tint = forceColour(most > 0 ? k.force / most : 0);
      const title = s('title', {}, `${k.kind}, ${this.units.text(k.force, 'force')}`);
      if (k.kind === 'point') {
        const radius = contacts.length > 200 ? 2.5 : 5.5;
        c.plot.append(s('circle', { cx: c.x(k.start), cy: c.y(wrapped(k.angle_start)), r: radius, fill: tint, class: 'touch' }, title));
        continue;
      }
      const points = this.along(k.start, k.end, k.angle_start, k.angle_end);
      c.plot.append(s('path', { d: path(points), stroke: tint, class: 'touch-line' }, title));
    }
    this.here = s('g', { class: 'here' });
    c.over.append(this.here);
    this.element.replaceChildren(c.svg);
    this.mark();
  }

  // The angle between the ends of a line contact, from the fields where there are any.
  private along(start: number, end: number, from: number, to: number): ([number, number] | null)[] {
    const c = this.chart!;
    const list: [number, number][] = [[start, from]];
    const step = this.store.current;
    if (step && hasFields(step)) {
      const f = step.fields!;
      f.S.forEach((S, i) => {
        if (S! > start && S! < end) list.push([S!, Math.atan2(f.delta2[i] ?? 0, f.delta1[i] ?? 0)]);
      });
    }
    list.push([end, to]);
    const out: ([number, number] | null)[] = [];
    let before: number | null = null;
    for (const [S, angle] of list) {
      const beta = wrapped(angle);
      if (before !== null && Math.abs(beta - before) > Math.PI) out.push(null);
      before = beta;
      out.push([c.x(S), c.y(beta)]);
    }
    return out;
  }

  private mark(): void {
    const step = this.store.current;
    const c = this.chart;
    if (!c || !this.here || !step || !hasFields(step)) return;
    const { row } = this.store;
    const f = step.fields!;
    const x = c.x(f.S[row]!);
    const [a, b] = [f.delta1[row] ?? 0, f.delta2[row] ?? 0];
    this.here.replaceChildren(
      s('line', { x1: x, x2: x, y1: c.y(Math.PI), y2: c.y(-Math.PI) }),
      s('circle', { cx: x, cy: c.y(Math.atan2(b, a)), r: 8 }),
    );
  }
}
