// Where things are drawn. Everything in double precision around an origin of one's choice; radii may be exaggerated by a
// factor: a place at eccentricity δ is drawn at R + factor δ. At factor 1 the rod is where the file says.

import type { Fields, Result, Step, Tube } from './result';

export type Vec = [number, number, number];
export const add = (a: Vec, b: Vec, t = 1): Vec => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
export const sub = (a: Vec, b: Vec): Vec => add(a, b, -1);
export const scaled = (a: Vec, t: number): Vec => [a[0] * t, a[1] * t, a[2] * t];
export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a: Vec): number => Math.hypot(...a);
export function unit(a: Vec, otherwise: Vec = [1, 0, 0]): Vec {
  const size = norm(a);
  return size > 0 ? scaled(a, 1 / size) : otherwise;
}

export interface Section {
  S: number;
  R: Vec;
  D1: Vec;
  D2: Vec;
  clearance: number;
}

export interface Basis {
  right: Vec;
  up: Vec;
  toEye: Vec;
}

export class Geometry {
  readonly centre: Vec;
  readonly size: number; // diagonal of the box around the axis
  readonly clearance: number; // largest
  readonly rodRadius: number; // of the case, else a tenth of the clearance, for the eye
  readonly sign: 1 | -1;
  private readonly frames = new WeakMap<Fields, { D1: Vec[]; D2: Vec[] }>();

  constructor(
    readonly tube: Tube,
    private readonly result: Result,
  ) {
    const low: Vec = [Infinity, Infinity, Infinity];
    const high: Vec = [-Infinity, -Infinity, -Infinity];
    for (const [k, name] of (['x', 'y', 'z'] as const).entries()) {
      for (const v of tube[name]) {
        low[k] = Math.min(low[k], v);
        high[k] = Math.max(high[k], v);
      }
    }
    this.clearance = Math.max(...tube.clearance);
    this.centre = scaled(add(low, high), 0.5);
    this.size = Math.max(norm(sub(high, low)), 2 * this.clearance);
    this.rodRadius = tube.rod_radius ?? 0.12 * this.clearance;
    this.sign = tube.side === 'outside' ? -1 : 1;
  }

  /** Sample i of the tube. */
  sample(i: number): Section {
    const t = this.tube;
    return {
      S: t.S[i],
      R: [t.x[i], t.y[i], t.z[i]],
      D1: [t.D1x[i], t.D1y[i], t.D1z[i]],
      D2: [t.D2x[i], t.D2y[i], t.D2z[i]],
      clearance: t.clearance[i],
    };
  }

  /** Between samples: linear, frame set right again. */
  at(S: number): Section {
    const t = this.tube.S;
    let low = 0;
    let high = t.length - 1;
    while (high - low > 1) {
      const mid = (low + high) >> 1;
      if (t[mid] <= S) low = mid;
      else high = mid;
    }
    const a = this.sample(low);
    const b = this.sample(high);
    const x = Math.min(Math.max((S - a.S) / (b.S - a.S || 1), 0), 1);
    const mix = (p: Vec, q: Vec): Vec => add(scaled(p, 1 - x), q, x);
    const D1 = unit(mix(a.D1, b.D1), a.D1);
    const D2raw = mix(a.D2, b.D2);
    const D2 = unit(sub(D2raw, scaled(D1, dot(D1, D2raw))), a.D2);
    return { S, R: mix(a.R, b.R), D1, D2, clearance: a.clearance * (1 - x) + b.clearance * x };
  }

  /** Radius of the drawn wall: where the rod's surface touches. */
  wallRadius(section: Section, factor: number): number {
    return Math.max(section.clearance + this.sign * this.rodRadius, 0.05 * section.clearance) * factor;
  }

  /** Centreline of the rod at a row of the fields. */
  rod(step: Step, row: number, factor: number): Vec {
    const f = step.fields!;
    const { D1, D2 } = this.framesOf(f);
    const more = factor - 1;
    const p: Vec = [f.x[row] ?? NaN, f.y[row] ?? NaN, f.z[row] ?? NaN];
    return add(add(p, D1[row], more * (f.delta1[row] ?? 0)), D2[row], more * (f.delta2[row] ?? 0));
  }

  /** Unit vector from the axis to the rod; zero on the axis. */
  outward(step: Step, row: number): Vec {
    const f = step.fields!;
    const { D1, D2 } = this.framesOf(f);
    return unit(add(scaled(D1[row], f.delta1[row] ?? 0), D2[row], f.delta2[row] ?? 0), [0, 0, 0]);
  }

  /** From the wall to the rod: the direction in which the wall pushes. */
  push(S: number, angle: number): Vec {
    const { D1, D2 } = this.at(S);
    return scaled(add(scaled(D1, Math.cos(angle)), D2, Math.sin(angle)), -this.sign);
  }

  /** On the wall, at the rod's centreline in contact. */
  touching(S: number, angle: number, factor: number): Vec {
    const section = this.at(S);
    const q = section.clearance * factor;
    return add(add(section.R, section.D1, q * Math.cos(angle)), section.D2, q * Math.sin(angle));
  }

  /** Exaggeration at the start, and the most of it: the tube must be seen, and must not overlap itself in bends. */
  factors(): { start: number; most: number } {
    const bend = Math.max(...this.tube.curvature.map((k, i) => k * (this.tube.clearance[i] + this.rodRadius)));
    const most = Math.max(1, Math.min(Math.max(4, (0.06 * this.size) / this.clearance), 0.8 / Math.max(bend, 1e-12)));
    return { start: Math.min(most, Math.max(1, (0.016 * this.size) / this.clearance)), most };
  }

  /** A view that shows the tube broadly: gravity down if there is weight, else its longest extent across. */
  view(tilt: number): Basis {
    const t = this.tube;
    const n = t.S.length;
    let m = [0, 0, 0, 0, 0, 0, 0, 0, 0];
    for (let i = 0; i < n; ++i) {
      const d = sub([t.x[i], t.y[i], t.z[i]], this.centre);
      for (let a = 0; a < 3; ++a) for (let b = 0; b < 3; ++b) m[3 * a + b] += d[a] * d[b];
    }
    const weight = (this.result.case?.resolved?.body_force ?? [0, 0, 0]) as Vec;
    const gravity = norm(weight) > 0 ? unit(weight) : null;
    const apart = (v: Vec, from: Vec[]): Vec => from.reduce((w, d) => sub(w, scaled(d, dot(d, w))), v);
    const longest = (from: Vec[]): Vec => {
      let best: Vec = [0, 0, 0];
      for (const start of [[1, 0.3, 0.2], [0.2, 1, 0.3], [0.3, 0.2, 1]] as Vec[]) {
        let v = unit(apart(start, from));
        for (let i = 0; i < 60; ++i) {
          const w: Vec = [0, 1, 2].map((a) => m[3 * a] * v[0] + m[3 * a + 1] * v[1] + m[3 * a + 2] * v[2]) as Vec;
          if (norm(apart(w, from)) < 1e-14 * this.size * this.size * n) break;
          v = unit(apart(w, from));
        }
        const stretch = (u: Vec) => dot(u, [0, 1, 2].map((a) => m[3 * a] * u[0] + m[3 * a + 1] * u[1] + m[3 * a + 2] * u[2]) as Vec);
        if (norm(best) === 0 || stretch(v) > stretch(best) * (1 + 1e-9)) best = v;
      }
      return best;
    };
    let up: Vec, right: Vec;
    if (gravity) {
      up = scaled(gravity, -1);
      right = longest([up]);
    } else {
      right = longest([]);
      up = longest([right]);
    }
    const along = sub(this.sample(n - 1).R, this.sample(0).R);
    if (dot(right, along) < 0) right = scaled(right, -1);
    if (!gravity && up[2] < 0) up = scaled(up, -1);
    const back = cross(right, up);
    const toEye = unit(add(scaled(back, Math.cos(tilt)), up, Math.sin(tilt)));
    return { right, up: cross(toEye, right), toEye };
  }

  private framesOf(f: Fields): { D1: Vec[]; D2: Vec[] } {
    let frames = this.frames.get(f);
    if (!frames) {
      frames = { D1: [], D2: [] };
      for (const S of f.S) {
        const section = this.at(S ?? 0);
        frames.D1.push(section.D1);
        frames.D2.push(section.D2);
      }
      this.frames.set(f, frames);
    }
    return frames;
  }
}
