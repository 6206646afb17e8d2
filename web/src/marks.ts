// What the pictures show of the contacts, the same for the scene and for the flat views: stretches of rod in line
// contact, points, and the concentrated reactions of the wall on the rod.

import { type Geometry, type Vec } from './geometry';
import { nearestRow, type Step } from './result';
import { forceColour } from './theme';

export interface Marks {
  lines: { rows: number[]; colour: string; force: number }[]; // rows of the fields
  points: { S: number; angle: number; colour: string; force: number }[];
  reactions: { S: number; angle: number; force: number; share: number; colour: string; push: Vec }[];
  largest: number; // contact force that has the last colour
}

export function marksOf(step: Step, geometry: Geometry): Marks {
  const largest = Math.max(0, ...step.contacts.map((c) => c.force));
  const concentrated = step.contacts.flatMap((c) => (c.kind !== 'line' ? [c.force] : [c.force_start ?? 0, c.force_end ?? 0]));
  const strongest = Math.max(0, ...concentrated);
  const out: Marks = { lines: [], points: [], reactions: [], largest };
  const S = step.fields?.S ?? [];
  for (const c of step.contacts) {
    const colour = forceColour(largest > 0 ? c.force / largest : 0);
    const react = (at: number, angle: number, force: number | null) => {
      if (force !== null && force > 1e-6 * strongest)
        out.reactions.push({ S: at, angle, force, share: force / strongest, colour, push: geometry.push(at, angle) });
    };
    if (c.kind !== 'line') {
      out.points.push({ S: c.start, angle: c.angle_start, colour, force: c.force });
      react(c.start, c.angle_start, c.force);
    } else {
      const rows: number[] = [];
      for (let i = nearestRow(S, c.start); i < S.length && (S[i] ?? 0) <= c.end; ++i) if ((S[i] ?? 0) >= c.start) rows.push(i);
      out.lines.push({ rows, colour, force: c.force });
      react(c.start, c.angle_start, c.force_start);
      react(c.end, c.angle_end, c.force_end);
    }
  }
  return out;
}
