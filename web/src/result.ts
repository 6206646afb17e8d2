// The result file as the page holds it; keys are those of the file (docs/report.md).

export type Column = (number | null)[];

export interface Contact {
  kind: 'point' | 'line' | 'collar';
  start: number;
  end: number;
  s_start: number;
  s_end: number;
  angle_start: number;
  angle_end: number;
  force_start: number | null;
  force_end: number | null;
  force_distributed: number | null;
  force: number;
  force_vector: [number, number, number];
  pressure_min: number | null;
  pressure_max: number | null;
  pressure_mid: number | null;
}

export const fieldNames = [
  'S', 's', 'x', 'y', 'z', 'delta1', 'delta2', 'phi', 'gap', 'pressure', 'F1', 'F2', 'F3', 'M1', 'M2', 'M3', 'kappa',
] as const;
export type FieldName = (typeof fieldNames)[number];
export type Fields = Record<FieldName, Column>;

export interface Step {
  parameter: number | null;
  status: string;
  message: string;
  rod_length: number | null;
  axial_force_start: number | null;
  axial_force_end: number | null;
  torque_start: number | null;
  torque_end: number | null;
  push: number | null;
  contacts: Contact[];
  segments: { kind: 'free' | 'line'; start: number; end: number }[];
  stability: string;
  branch: string;
  certificate: Record<string, number | null>;
  effort: Record<string, number>;
  fields?: Fields;
}

export interface PathEvent {
  parameter: number;
  kind: string;
  S: number | null;
  rod_length: number | null;
  axial_force_end: number | null;
}

export interface TracePoint {
  parameter: number;
  rod_length: number | null;
  axial_force_end: number | null;
  torque_end: number | null;
  contacts: number;
}

type TubeColumn = 'S' | 'x' | 'y' | 'z' | 'D1x' | 'D1y' | 'D1z' | 'D2x' | 'D2y' | 'D2z' | 'clearance' | 'curvature';
export type Tube = { side: 'inside' | 'outside'; rod_radius: number | null } & Record<TubeColumn, number[]>;

export interface Result {
  tendril: string;
  result_schema: number;
  case: any;
  status: string;
  message: string;
  interrupted: boolean;
  notes?: string[];
  tube?: Tube;
  steps: Step[];
  events: PathEvent[];
  trace: TracePoint[];
}

export interface Thinned {
  rows: number;
  rows_kept: number;
  steps: number;
  steps_kept: number;
  trace: number;
  trace_kept: number;
}

export interface PageData {
  page: { tendril: string; thinned: Thinned | null };
  result: Result;
}

export function readPage(): PageData {
  return JSON.parse(document.getElementById('tendril-result')!.textContent!);
}

export const hasFields = (step: Step): boolean => !!step.fields && step.fields.S.length > 1;

/** False for a step that found no state at all: its numbers mean nothing. */
export const reached = (step: Step | undefined): step is Step => !!step && (step.status === 'converged' || hasFields(step) || (step.rod_length ?? 0) > 0);

/** Where a contact is, as one place. */
export const middle = (contact: Contact): number => 0.5 * (contact.start + contact.end);

export function largest(contacts: Contact[]): Contact | null {
  let best: Contact | null = null;
  for (const contact of contacts) if (!best || contact.force > best.force) best = contact;
  return best;
}

/** Row of a column in ascending order that is nearest to a value. */
export function nearestRow(column: Column, value: number): number {
  let low = 0;
  let high = column.length - 1;
  while (high - low > 1) {
    const mid = (low + high) >> 1;
    if ((column[mid] ?? 0) <= value) low = mid;
    else high = mid;
  }
  return value - (column[low] ?? 0) <= (column[high] ?? 0) - value ? low : high;
}
