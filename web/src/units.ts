// How quantities are shown: a unit with a prefix that suits the size, chosen once per page and quantity. Values stay as
// in the file everywhere else.

import type { Result } from './result';

export type Kind = 'length' | 'gap' | 'force' | 'moment' | 'pressure' | 'curvature' | 'angle' | 'none';

export interface Unit {
  label: string; // "" without unit
  factor: number; // shown = value * factor
}

const si: Record<Exclude<Kind, 'angle' | 'none'>, [string, number][]> = {
  length: [['m', 1], ['mm', 1e3], ['µm', 1e6]],
  gap: [['m', 1], ['mm', 1e3], ['µm', 1e6]],
  force: [['MN', 1e-6], ['kN', 1e-3], ['N', 1], ['mN', 1e3], ['µN', 1e6]],
  moment: [['MN m', 1e-6], ['kN m', 1e-3], ['N m', 1], ['N mm', 1e3], ['µN m', 1e6]],
  pressure: [['MN/m', 1e-6], ['kN/m', 1e-3], ['N/m', 1], ['mN/m', 1e3]],
  curvature: [['1/m', 1], ['1/km', 1e3]],
};

// What a path parameter measures, from the name of its key.
function kindOfKey(key: string): Kind {
  if (/(axial_force|push)$/.test(key)) return 'force';
  if (/torque$/.test(key)) return 'moment';
  if (/(rod_length|position|eccentricity(\.\d)?|clearance|radius)$/.test(key)) return 'length';
  if (/(twist|roll)$/.test(key)) return 'angle';
  return 'none';
}

export class Units {
  readonly si: boolean;
  readonly place: string; // heading of S
  readonly parameter: { name: string; kind: Kind; heading: string };
  private readonly units = new Map<Kind, Unit>();

  constructor(result: Result) {
    this.si = String(result.case?.resolved?.units ?? '').startsWith('m,');
    this.units.set('none', { label: '', factor: 1 });
    this.units.set('angle', this.si ? { label: '°', factor: 180 / Math.PI } : { label: 'rad', factor: 1 });
    const most: Record<string, number> = { length: 0, gap: 0, force: 0, moment: 0, pressure: 0, curvature: 0 };
    const see = (kind: Kind, value: number | null | undefined) => {
      if (value !== null && value !== undefined && Number.isFinite(value)) most[kind] = Math.max(most[kind], Math.abs(value));
    };
    see('length', result.case?.resolved?.axis_length);
    for (const name of ['clearance_start', 'clearance_end']) see('gap', result.case?.resolved?.[name]);
    for (const value of result.tube?.clearance ?? []) see('gap', value);
    for (const step of result.steps) {
      see('length', step.rod_length);
      for (const value of [step.axial_force_start, step.axial_force_end, step.push]) see('force', value);
      for (const value of [step.torque_start, step.torque_end]) see('moment', value);
      for (const c of step.contacts) {
        see('force', c.force);
        see('pressure', c.pressure_max);
      }
      for (const name of ['M1', 'M2', 'M3'] as const) for (const value of step.fields?.[name] ?? []) see('moment', value);
      for (const value of step.fields?.kappa ?? []) see('curvature', value);
    }
    for (const [kind, table] of Object.entries(si)) {
      const fits = table.find(([, factor]) => most[kind] * factor >= 1) ?? table[table.length - 1];
      const unit = most[kind] > 0 ? fits : (table.find(([, factor]) => factor === 1) ?? fits);
      this.units.set(kind as Kind, this.si ? { label: unit[0], factor: unit[1] } : { label: '', factor: 1 });
    }
    this.parameter = this.parameterOf(result);
    const axis = result.case?.tube?.axis;
    const from = axis?.kind === 'survey' && axis.from ? `, from ${this.text(axis.from, 'length', 6)} measured depth` : '';
    this.place = this.heading('S along the tube', 'length') + from;
  }

  private parameterOf(result: Result) {
    const name = String(result.case?.path?.parameter ?? 'parameter');
    const kind = kindOfKey(name);
    const plain = result.case?.resolved?.path_unit;
    return { name, kind, heading: kind === 'none' && plain ? `${name} [${plain}]` : this.heading(name, kind) };
  }
  parameterText(value: number | null, digits = 6): string {
    return `${this.parameter.name} = ${this.text(value, this.parameter.kind, digits)}`;
  }

  of(kind: Kind): Unit {
    return this.units.get(kind)!;
  }
  /** "gap [mm]" */
  heading(name: string, kind: Kind): string {
    const label = this.of(kind).label;
    return label ? `${name} [${label}]` : name;
  }
  number(value: number | null | undefined, kind: Kind, digits = 6): string {
    return value === null || value === undefined ? '–' : format(value * this.of(kind).factor, digits);
  }
  /** With its unit. */
  text(value: number | null | undefined, kind: Kind, digits = 4): string {
    const label = this.of(kind).label;
    const space = label === '' || label === '°' ? '' : '\u202f';
    return value === null || value === undefined ? '–' : this.number(value, kind, digits) + space + label;
  }
}

const superscript = (n: number) => String(n).replace(/./g, (c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(c)]));

/** Significant digits without trailing zeros, a real minus sign, powers of ten beyond 10⁶ and below 10⁻⁴. */
export function format(value: number, digits = 6): string {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  let text: string;
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(Math.min(digits, 4) - 1).split('e');
    text = `${Number(mantissa)}·10${superscript(Number(exponent))}`;
  } else {
    text = String(Number(value.toPrecision(digits)));
  }
  return text.replace('-', '−');
}

/** An upper bound in one digit: 1.2e-10 -> "2·10⁻¹⁰". */
export function bound(value: number): string {
  if (!(value > 0)) return '0';
  let exponent = Math.floor(Math.log10(value));
  let digit = Math.ceil(value / 10 ** exponent - 1e-9);
  if (digit >= 10) [digit, exponent] = [1, exponent + 1];
  return `${digit === 1 ? '' : `${digit}·`}10${superscript(exponent)}`;
}

/** Rounding noise of a quantity, this small beside its fellows, is shown as 0. */
export const quiet = (value: number | null, scale: number): number | null =>
  value !== null && Math.abs(value) < 1e-10 * scale ? 0 : value;
