// What is selected: a step of the path and a row of its fields (the marker). Every view listens.

import { hasFields, largest, middle, nearestRow, type Result, type Step } from './result';

type What = 'step' | 'row' | 'look';

export class Store {
  step = 0;
  row = 0;
  private readonly listeners: ((what: What) => void)[] = [];

  constructor(readonly result: Result) {
    this.step = Math.max(result.steps.length - 1, 0);
    this.row = this.home();
  }

  /** Undefined where nothing was reached. */
  get current(): Step | undefined {
    return this.result.steps[this.step];
  }
  get place(): number {
    return this.current?.fields?.S[this.row] ?? 0;
  }

  listen(listener: (what: What) => void): void {
    this.listeners.push(listener);
  }
  /** Colours changed: draw again. */
  look(): void {
    this.tell('look');
  }
  setStep(step: number): void {
    const next = Math.min(Math.max(step, 0), this.result.steps.length - 1);
    if (next === this.step) return;
    this.step = next;
    this.row = this.home();
    this.tell('step');
  }
  setRow(row: number): void {
    const count = this.current?.fields?.S.length ?? 0;
    const next = Math.min(Math.max(row, 0), count - 1);
    if (count === 0 || next === this.row) return;
    this.row = next;
    this.tell('row');
  }
  setPlace(S: number): void {
    if (this.current?.fields) this.setRow(nearestRow(this.current.fields.S, S));
  }
  /** To the next contact along the tube, or the one before. */
  toContact(direction: 1 | -1): void {
    const places = (this.current?.contacts ?? []).map(middle);
    const width = 1e-6 * Math.abs(places[places.length - 1] ?? 1);
    const next =
      direction > 0 ? places.find((S) => S > this.place + this.spacing() + width) : places.findLast((S) => S < this.place - this.spacing() - width);
    if (next !== undefined) this.setPlace(next);
  }

  private spacing(): number {
    const S = this.current?.fields?.S ?? [];
    const a = S[Math.max(this.row - 1, 0)] ?? 0;
    const b = S[Math.min(this.row + 1, S.length - 1)] ?? 0;
    return 0.5 * (b - a);
  }
  // Where the contact force is largest, else the middle.
  private home(): number {
    const step = this.current;
    if (!step || !hasFields(step)) return 0;
    const contact = largest(step.contacts);
    const S = step.fields!.S;
    return contact ? nearestRow(S, middle(contact)) : S.length >> 1;
  }
  private tell(what: What): void {
    for (const listener of this.listeners) listener(what);
  }
}
