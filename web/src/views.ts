// The picture without WebGL: the tube and the rod as SVG, seen broadside and from above.

import { path } from './chart';
import { h, s } from './dom';
import { add, cross, dot, scaled, sub, type Basis, type Geometry, type Vec } from './geometry';
import { marksOf } from './marks';
import { hasFields } from './result';
import type { Store } from './store';

const kWidth = 760;
const kArrow = 46;

export class FlatViews {
  readonly element = h('div', { class: 'flat-views' });
  factor: number;
  private readonly places: ((p: Vec) => [number, number])[] = [];
  private readonly here: SVGElement[] = [];

  constructor(
    private readonly geometry: Geometry,
    private readonly store: Store,
  ) {
    this.factor = geometry.factors().start;
    store.listen((what) => (what === 'row' ? this.mark() : this.build()));
    this.build();
  }

  setFactor(factor: number): void {
    this.factor = factor;
    this.build();
  }

  private build(): void {
    this.places.length = this.here.length = 0;
    const broad = this.geometry.view(0);
    const above: Basis = { right: broad.right, up: scaled(broad.toEye, -1), toEye: broad.up };
    this.element.replaceChildren(this.view(broad, 'Broadside'), this.view(above, 'From above'));
    this.mark();
  }

  private view(basis: Basis, name: string): HTMLElement {
    const g = this.geometry;
    const n = g.tube.S.length;
    const every = Math.max(1, Math.floor(n / 800));
    const walls: [Vec[], Vec[]] = [[], []];
    for (let i = 0; i < n; i += i + every >= n && i !== n - 1 ? n - 1 - i : every) {
      const section = g.sample(i);
      const across = cross(cross(section.D1, section.D2), basis.toEye);
      const size = Math.hypot(...across) || 1;
      const r = g.wallRadius(section, this.factor) / size;
      walls[0].push(add(section.R, across, r));
      walls[1].push(add(section.R, across, -r));
      if (i === n - 1) break;
    }
    const flat = (p: Vec): [number, number] => [dot(sub(p, g.centre), basis.right), -dot(sub(p, g.centre), basis.up)];
    const all = walls.flat().map(flat);
    const low = [0, 1].map((k) => Math.min(...all.map((p) => p[k])));
    const high = [0, 1].map((k) => Math.max(...all.map((p) => p[k])));
    const margin = kArrow + 8;
    const scale = (kWidth - 2 * margin) / Math.max(high[0] - low[0], (high[1] - low[1]) * 0.6, 1e-300);
    const at = (p: Vec): [number, number] => {
      const [x, y] = flat(p);
      return [margin + (x - low[0]) * scale, margin + (y - low[1]) * scale];
    };
    const height = 2 * margin + (high[1] - low[1]) * scale;
    const svg = s('svg', { viewBox: `0 0 ${kWidth} ${height.toFixed(0)}`, width: '100%', role: 'img', 'aria-label': `Rod in its tube, ${name.toLowerCase()}` });
    svg.append(
      s('path', { class: 'tube-fill', d: `${path(walls[0].map(at))}${path([...walls[1]].reverse().map(at)).replace('M', 'L')}Z` }),
      s('path', { class: 'tube-edge', d: path(walls[0].map(at)) + path(walls[1].map(at)) }),
    );
    const step = this.store.current;
    if (step && hasFields(step)) {
      const rod = step.fields!.S.map((_, row) => at(g.rod(step, row, this.factor)));
      const thick = Math.max(2, 2 * g.rodRadius * this.factor * scale);
      svg.append(s('path', { class: 'rod', d: path(rod), 'stroke-width': thick }));
      const marks = marksOf(step, g);
      for (const line of marks.lines) svg.append(s('path', { d: path(line.rows.map((row) => rod[row])), stroke: line.colour, 'stroke-width': thick + 1.5, fill: 'none' }));
      for (const p of marks.points) {
        const [x, y] = at(g.touching(p.S, p.angle, this.factor));
        svg.append(s('circle', { cx: x, cy: y, r: Math.max(3.5, 0.8 * thick), fill: p.colour }));
      }
      for (const r of marks.reactions) {
        const [x, y] = at(g.touching(r.S, r.angle, this.factor));
        const d: [number, number] = [dot(r.push, basis.right), -dot(r.push, basis.up)];
        const long = kArrow * r.share;
        svg.append(
          s('line', { x1: x - long * d[0], y1: y - long * d[1], x2: x, y2: y, stroke: r.colour, 'stroke-width': 1.6 }),
          s('path', { d: `M${x} ${y}L${x - 7 * d[0] - 3 * d[1]} ${y - 7 * d[1] + 3 * d[0]}L${x - 7 * d[0] + 3 * d[1]} ${y - 7 * d[1] - 3 * d[0]}Z`, fill: r.colour }),
        );
      }
    }
    const here = s('circle', { class: 'here', r: 6 });
    svg.append(here);
    this.places.push(at);
    this.here.push(here);
    return h('figure', {}, svg, h('figcaption', {}, name));
  }

  private mark(): void {
    const step = this.store.current;
    if (!step || !hasFields(step)) return;
    const p = this.geometry.rod(step, this.store.row, this.factor);
    this.here.forEach((circle, i) => {
      const [x, y] = this.places[i](p);
      circle.setAttribute('cx', String(x));
      circle.setAttribute('cy', String(y));
    });
  }
}
