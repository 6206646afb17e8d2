// The state in words: verdict line, warnings, names of events.

import { hasFields, largest, reached, type Contact, type PageData, type Step } from './result';
import { bound, format, type Units } from './units';

const plural = (n: number, one: string, many = `${one}s`) => `${n} ${n === 1 ? one : many}`;

/** The worst figure of the certificate that should vanish. */
export function certified(step: Step): number | null {
  const c = step.certificate;
  const figures = [c.equilibrium, c.error, c.continuity, c.balance, c.invariant_spread, c.phase_multiplier].map(Math.abs as any);
  for (const name of ['gap_min', 'reaction_min']) figures.push(Math.max(0, -(c[name] ?? 0)));
  const known = figures.filter((v) => Number.isFinite(v)) as number[];
  return known.length ? Math.max(...known) : null;
}

function where(contact: Contact, units: Units): string {
  const S = units.si ? '' : 'S = ';
  if (contact.kind === 'point') return `at ${S}${units.text(contact.start, 'length')}`;
  return `from ${S}${units.number(contact.start, 'length', 4)} to ${units.text(contact.end, 'length')}`;
}

function count(contacts: Contact[], units: Units): string {
  const points = contacts.filter((c) => c.kind === 'point');
  const lines = contacts.filter((c) => c.kind === 'line');
  const parts: string[] = [];
  if (points.length) parts.push(plural(points.length, 'point'));
  if (lines.length) {
    const lengths = lines.map((c) => c.end - c.start);
    const told =
      lines.length <= 3
        ? `of ${lengths.map((v) => units.text(v, 'length', 3)).join(' and ')}`
        : `of ${units.text(lengths.reduce((a, b) => a + b, 0), 'length', 3)} in all`;
    parts.push(`${plural(lines.length, 'line')} ${told}`);
  }
  if (contacts.length === 1) return parts[0].replace(/^1 (point|line)/, '1 $1 contact');
  return `${contacts.length} contacts: ${parts.join(', ')}`;
}

export function verdict(step: Step | undefined, units: Units): string {
  if (!reached(step)) return 'Not solved: no state was found.';
  const parts: string[] = [];
  const most = largest(step.contacts);
  if (most) {
    parts.push(count(step.contacts, units));
    parts.push(
      step.contacts.length === 1
        ? `force ${units.text(most.force, 'force')} ${where(most, units)}`
        : `largest force ${units.text(most.force, 'force')} ${where(most, units)}`,
    );
  } else {
    parts.push('No contact with the wall');
  }
  if (step.stability !== 'unknown') parts.push(step.stability);
  const worst = certified(step);
  if (worst !== null) parts.push(`certified to ${bound(worst)}`);
  if (step.status === 'outside_validity') parts.push('outside the range where the model holds');
  const told = `${parts.join('; ')}.`;
  return step.status === 'not_converged' ? `Not solved as asked; the state shown has ${told[0].toLowerCase()}${told.slice(1)}` : told;
}

export interface Warning {
  level: 'bad' | 'note';
  text: string;
}

export function warnings(data: PageData, step: Step | undefined, units: Units): Warning[] {
  const { result, page } = data;
  const out: Warning[] = [];
  // a sentence that begins with a file's name keeps it
  const sentence = (text: string) => (/^[\w]*[./\\]/.test(text) ? text[0] : text[0].toUpperCase()) + text.slice(1) + (/[.!?]$/.test(text) ? '' : '.');
  const bad = (text: string) => out.push({ level: 'bad', text: sentence(text) });
  const note = (text: string) => out.push({ level: 'note', text: sentence(text) });
  const failed = result.steps.filter((other) => other.status !== 'converged').length;
  if (result.status !== 'converged' && result.message) bad(result.message);
  if (failed && result.steps.length > 1) bad(`${failed} of ${result.steps.length} steps ${failed === 1 ? 'is not a converged state' : 'are not converged states'}.`);
  if (step && step.status !== 'converged' && step.message && step.message !== result.message) bad(step.message);
  if (step && step.status === 'converged' && step.message) bad(step.message);
  if (result.interrupted) bad('The run was interrupted: only what was reached until then is here.');
  const branch = step?.branch ? `: ${step.branch}` : '';
  if (step?.stability === 'unstable') bad(`This state is unstable${branch}`);
  if (reached(step)) {
    if (step.stability === 'unknown') note(`Whether this state is stable is not known${branch}`);
    const c = step.certificate;
    const worst = certified(step);
    if (worst !== null && worst > 1e-6) bad(`A figure of the certificate that should vanish is ${bound(worst)}.`);
    if ((c.curvature_max ?? 0) > 1e-6) bad('At a point contact the rod is curved more than the wall allows (curvature_max > 0).');
    if ((c.strain_max ?? 0) > 0.01)
      note(`The rod is stretched or shortened by up to ${format((c.strain_max ?? 0) * 100, 2)} %; the law of the rod is linear.`);
  }
  for (const event of result.events) {
    if (event.kind === 'jump') note(`The path jumps to another state at ${units.parameterText(event.parameter)}.`);
    if (event.kind === 'end_of_validity') bad(`The model ends to hold at ${units.parameterText(event.parameter)}.`);
  }
  for (const text of result.notes ?? []) note(text);
  if (reached(step) && !hasFields(step)) {
    note(
      page.thinned && page.thinned.steps_kept < page.thinned.steps
        ? 'The fields of this step were left out to keep the page small; others have them.'
        : 'This result has no fields along the rod: write it with --fields, or use `run --report`, for picture and tracks.',
    );
  }
  if (page.thinned) {
    const t = page.thinned;
    const parts: string[] = [];
    if (t.rows_kept < t.rows) parts.push(`${t.rows_kept} of ${t.rows} rows along the rod`);
    if (t.steps_kept < t.steps) parts.push(`fields of ${t.steps_kept} of ${t.steps} steps`);
    if (t.trace_kept < t.trace) parts.push(`${t.trace_kept} of ${t.trace} intermediate states`);
    note(`To keep this page small it holds ${parts.join(', ')}; the result file has all. Contacts and key numbers are complete.`);
  }
  return out;
}

export const eventWords: Record<string, string> = {
  contact_appears: 'a contact appears',
  contact_leaves: 'a contact leaves the wall',
  point_to_line: 'a point becomes a line',
  line_to_point: 'a line becomes a point',
  point_splits: 'a point splits in two',
  line_splits: 'a line splits',
  contacts_merge: 'contacts merge',
  fold: 'limit point (fold)',
  branch_point: 'branch point',
  jump: 'jump to another state',
  tip_touches: 'the tip touches',
  tip_leaves: 'the tip leaves the wall',
  end_of_validity: 'the model ends to hold',
};
export const eventName = (kind: string): string => eventWords[kind] ?? kind.replace(/_/g, ' ');
