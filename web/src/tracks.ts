// Linked plots along the tube. The arrays given to uPlot are those of the file, unchanged: units are a matter of labels.

import uPlot from 'uplot';

import { h, onceAFrame } from './dom';
import { fieldNames, hasFields, nearestRow, type FieldName, type Step } from './result';
import type { Store } from './store';
import { colour, forceColour } from './theme';
import { format, quiet, type Kind, type Units } from './units';

interface Series {
  field: FieldName;
  label: string;
  colour: string; // name in the style sheet
  fill?: boolean;
}
interface Track {
  id: string;
  title: string;
  kind: Kind;
  series: Series[];
  zero?: boolean; // the axis starts at 0
}

export const tracks: Track[] = [
  { id: 'gap', title: 'Gap to the wall', kind: 'gap', zero: true, series: [{ field: 'gap', label: 'gap', colour: 'c1', fill: true }] },
  { id: 'pressure', title: 'Pressure and reactions', kind: 'pressure', zero: true, series: [{ field: 'pressure', label: 'p', colour: 'c2', fill: true }] },
  { id: 'axial', title: 'Axial force', kind: 'force', series: [{ field: 'F3', label: 'F₃', colour: 'c1' }] },
  {
    id: 'shear',
    title: 'Shear force',
    kind: 'force',
    series: [
      { field: 'F1', label: 'F₁', colour: 'c1' },
      { field: 'F2', label: 'F₂', colour: 'c2' },
    ],
  },
  {
    id: 'bending',
    title: 'Bending moment',
    kind: 'moment',
    series: [
      { field: 'M1', label: 'M₁', colour: 'c1' },
      { field: 'M2', label: 'M₂', colour: 'c2' },
    ],
  },
  { id: 'twisting', title: 'Twisting moment', kind: 'moment', series: [{ field: 'M3', label: 'M₃', colour: 'c1' }] },
  { id: 'curvature', title: 'Curvature', kind: 'curvature', zero: true, series: [{ field: 'kappa', label: 'κ', colour: 'c1' }] },
];

// A group of quantities that are small together: rounding noise of one is not blown up to fill its track.
const groups: Partial<Record<FieldName, FieldName[]>> = {
  F1: ['F1', 'F2', 'F3'],
  F2: ['F1', 'F2', 'F3'],
  M1: ['M1', 'M2', 'M3'],
  M2: ['M1', 'M2', 'M3'],
  M3: ['M1', 'M2', 'M3'],
};

const kGutter = 64;
// Upright: depth downwards, tracks side by side, as wells are logged.
const kDepth = 600; // height of a track
const kPlace = 58; // of the depths beside the first
const kScale = 20; // of the values above (and of the reactions below)

export class Tracks {
  readonly element: HTMLElement;
  readonly plots = new Map<string, uPlot>();
  private readonly hosts = new Map<string, { plot: HTMLElement; values: HTMLElement }>();
  private readonly empty = h('p', { class: 'empty' }, 'No fields along the rod in this step.');
  private readonly sizes = new Map<FieldName, number>(); // largest value of a quantity and its fellows
  private range: [number, number] | null = null;
  private readonly refresh = onceAFrame(() => this.mark());

  constructor(
    private readonly store: Store,
    private readonly units: Units,
    private upright = false,
  ) {
    this.element = h('div', {
      class: upright ? 'tracks upright' : 'tracks',
      tabindex: 0,
      role: 'slider',
      'aria-label': 'Position along the tube; arrow keys move the marker, Page Up and Page Down go from contact to contact',
    });
    this.element.append(this.empty);
    for (const [i, track] of tracks.entries()) {
      const plot = h('div', { class: 'plot' });
      const values = h('span', { class: 'values' });
      this.hosts.set(track.id, { plot, values });
      const last = i === tracks.length - 1;
      this.element.append(
        h('div', { class: `track${last ? ' last' : ''}`, 'data-track': track.id }, h('div', { class: 'track-head' }, h('h3', {}, this.heading(track)), values), plot),
      );
    }
    this.element.addEventListener('keydown', (event) => this.key(event));
    this.element.addEventListener('dblclick', () => this.zoom(null));
    store.listen((what) => {
      if (what === 'row') this.refresh();
      else if (what === 'step') this.build();
      else for (const plot of this.plots.values()) plot.redraw(false);
    });
    new ResizeObserver(() => {
      this.measured = Math.max(this.element.clientWidth, 240);
      if (this.plots.size) this.resize();
      else this.build();
    }).observe(this.element);
  }

  private heading(track: Track): string {
    const { units } = this;
    if (track.id !== 'pressure') return units.heading(track.title, track.kind);
    const [p, f] = [units.of('pressure').label, units.of('force').label];
    return p ? `Pressure [${p}] and reactions [${f}]` : track.title;
  }

  /** Depth downwards and tracks side by side, or S to the right and tracks one above the other. */
  setUpright(upright: boolean): void {
    if (upright === this.upright) return;
    this.upright = upright;
    this.element.classList.toggle('upright', upright);
    this.measured = Math.max(this.element.clientWidth, 240);
    const range = this.range;
    this.build();
    this.zoom(range);
  }

  build(): void {
    for (const plot of this.plots.values()) plot.destroy();
    this.plots.clear();
    this.range = null;
    const step = this.store.current;
    const there = !!step && hasFields(step);
    this.element.classList.toggle('without-fields', !there);
    if (!there) return;
    this.sizes.clear();
    const size = (name: FieldName) => step.fields![name].reduce<number>((m, v) => Math.max(m, Math.abs(v ?? 0)), 0);
    for (const name of fieldNames) this.sizes.set(name, Math.max(...(groups[name] ?? [name]).map(size)));
    for (const track of tracks) {
      this.plots.set(track.id, this.plot(track, step));
      this.frame(track);
    }
    this.mark();
  }

  /** Width while printing; 0: as wide as the page gives. */
  fixedWidth = 0;
  private get width(): number {
    return this.fixedWidth || this.measured;
  }
  private measured = 600;
  private widthOf(track: Track): number {
    if (!this.upright) return this.width;
    return Math.floor((this.width - kPlace) / tracks.length) + (track === tracks[0] ? kPlace : 0);
  }
  private height(track: Track): number {
    if (this.upright) return kDepth;
    const tall = track.id === 'gap' || track.id === 'pressure' ? 92 : 74;
    return track.id === 'curvature' ? tall + 38 : tall;
  }
  resize(): void {
    for (const track of tracks) {
      const plot = this.plots.get(track.id);
      if (!plot || plot.width === this.widthOf(track)) continue;
      plot.setSize({ width: this.widthOf(track), height: this.height(track) });
      this.frame(track);
    }
  }

  // Upright, a track is as wide as its plot: its heading breaks instead of pushing its neighbours away.
  private frame(track: Track): void {
    const around = this.hosts.get(track.id)!.plot.parentElement!;
    around.style.width = this.upright ? `${this.widthOf(track)}px` : '';
  }

  private plot(track: Track, step: Step): uPlot {
    const fields = step.fields!;
    const size = Math.max(...track.series.map((series) => this.sizes.get(series.field)!));
    const { upright } = this;
    const places = upright ? track === tracks[0] : track.id === 'curvature'; // this one shows S
    const reactions = track.id === 'pressure' ? this.reactions(step) : [];
    const strongest = Math.max(0, ...reactions.map((r) => r.force));
    const axis = (extra: uPlot.Axis): uPlot.Axis => ({
      stroke: () => colour('muted'),
      font: '11px system-ui, sans-serif',
      grid: { stroke: () => colour('grid'), width: 1 },
      ticks: { show: false },
      ...extra,
    });
    const format1 = (kind: Kind) => (_: uPlot, splits: number[]) => splits.map((v) => format(v * this.units.of(kind).factor, 6));
    const yRange = (_: uPlot, low: number | null, high: number | null): [number, number] => {
      let [a, b] = [low ?? 0, high ?? 0];
      if (track.zero) a = Math.min(a, 0);
      if (b - a < 1e-6 * size || b === a) {
        const mid = 0.5 * (a + b);
        const half = 0.1 * (size || 1);
        if (track.zero) b = a + 2 * half;
        else [a, b] = [mid - half, mid + half];
      }
      const pad = 0.08 * (b - a);
      return [track.zero && a === 0 ? 0 : a - pad, b + pad];
    };
    const options: uPlot.Options = {
      width: this.widthOf(track),
      height: this.height(track),
      padding: upright ? [0, 10, track.id === 'pressure' ? 0 : kScale, places ? 0 : 8] : [6, track.id === 'pressure' ? 0 : kGutter - 8, places ? 0 : 4, 0],
      legend: { show: false },
      pxAlign: 0,
      cursor: {
        y: false, // the line across the places is the one of uPlot's x, whichever way that runs
        points: { show: true, size: 6 },
        drag: { x: true, y: false, setScale: false },
        move: (u, left, top) => {
          if (left >= 0) this.store.setRow(nearestRow(fields.S, u.posToVal(upright ? top : left, 'x')));
          return [left, top];
        },
      },
      scales: {
        x: { time: false, ori: upright ? 1 : 0, dir: upright ? -1 : 1, range: () => this.range ?? [fields.S[0]!, fields.S[fields.S.length - 1]!] },
        y: { ori: upright ? 0 : 1, range: yRange },
        force: { ori: upright ? 0 : 1, range: () => [0, strongest > 0 ? 1.16 * strongest : 1] },
      },
      axes: [
        axis({
          side: upright ? 3 : 2,
          size: places ? (upright ? kPlace - 16 : 22) : 0,
          show: true,
          values: places ? format1('length') : () => [],
          space: upright ? 34 : 64,
          ...(places ? { label: this.units.place, labelSize: 16, labelFont: '11px system-ui, sans-serif', labelGap: 0 } : {}),
        }),
        axis({ side: upright ? 0 : 3, size: upright ? kScale : kGutter - 8, space: upright ? 38 : 21, values: format1(track.kind), scale: 'y' }),
        ...(track.id === 'pressure'
          ? [axis({ side: upright ? 2 : 1, scale: 'force', size: upright ? kScale : kGutter - 8, space: upright ? 38 : 21, values: format1('force'), grid: { show: false } })]
          : []),
      ],
      series: [
        {},
        ...track.series.map(
          (series): uPlot.Series => ({
            label: series.label,
            scale: 'y',
            stroke: () => colour(series.colour),
            width: 1.5,
            fill: series.fill ? () => colour(`${series.colour}-soft`) : undefined,
            points: { show: false },
          }),
        ),
        ...(track.id === 'pressure' ? [{ show: true, scale: 'force', stroke: 'transparent', points: { show: false } } as uPlot.Series] : []),
      ],
      hooks: {
        ready: [() => this.refresh()], // before, a plot has no size and would hide the marker
        drawClear: [(u) => this.bands(u, step)],
        draw: [(u) => this.stems(u, reactions)],
        setSelect: [
          (u) => {
            const { left, top, width, height } = u.select;
            const [from, over] = upright ? [top, height] : [left, width];
            if (over < 4) return;
            this.zoom([u.posToVal(from, 'x'), u.posToVal(from + over, 'x')]);
            u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          },
        ],
      },
    };
    const data = [fields.S, ...track.series.map((series) => fields[series.field])] as uPlot.AlignedData;
    if (track.id === 'pressure') (data as unknown[]).push(fields.S.map(() => null));
    return new uPlot(options, data, this.hosts.get(track.id)!.plot);
  }

  private zoom(range: [number, number] | null): void {
    this.range = range;
    const S = this.store.current?.fields?.S;
    if (!S) return;
    const [min, max] = range ?? [S[0]!, S[S.length - 1]!];
    for (const plot of this.plots.values()) plot.setScale('x', { min, max });
  }

  private reactions(step: Step): { S: number; force: number; colour: string }[] {
    const most = Math.max(0, ...step.contacts.map((c) => c.force));
    return step.contacts.flatMap((c) => {
      const tint = forceColour(most > 0 ? c.force / most : 0);
      const places: [number, number | null][] = c.kind !== 'line' ? [[c.start, c.force]] : [[c.start, c.force_start], [c.end, c.force_end]];
      return places.flatMap(([S, force]) => (force === null ? [] : [{ S, force, colour: tint }]));
    });
  }

  // Where the rod touches: line contacts as bands, points as dashed lines, behind the curves.
  private bands(u: uPlot, step: Step): void {
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = colour('band');
    ctx.strokeStyle = colour('band-line');
    ctx.lineWidth = devicePixelRatio;
    // Dashes closer than a few pixels would be a grey wall: they come back when zoomed in.
    const length = this.upright ? bbox.height : bbox.width;
    const perContact = length / Math.max(1, step.contacts.filter((c) => c.end >= u.scales.x.min! && c.start <= u.scales.x.max!).length);
    const dense = perContact < 6 * devicePixelRatio;
    for (const c of step.contacts) {
      const at = u.valToPos(c.start, 'x', true);
      if (c.kind !== 'line' && dense) continue;
      if (c.kind === 'line') {
        const over = Math.max(u.valToPos(c.end, 'x', true) - at, 1);
        if (this.upright) ctx.fillRect(bbox.left, at, bbox.width, over);
        else ctx.fillRect(at, bbox.top, over, bbox.height);
      } else {
        ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
        ctx.beginPath();
        const sharp = Math.round(at) + 0.5;
        if (this.upright) {
          ctx.moveTo(bbox.left, sharp);
          ctx.lineTo(bbox.left + bbox.width, sharp);
        } else {
          ctx.moveTo(sharp, bbox.top);
          ctx.lineTo(sharp, bbox.top + bbox.height);
        }
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  private stems(u: uPlot, reactions: { S: number; force: number; colour: string }[]): void {
    if (!reactions.length) return;
    const { ctx, bbox } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left - 4, bbox.top - 4, bbox.width + 8, bbox.height + 8);
    ctx.clip();
    const thin = reactions.length > 150;
    for (const r of reactions) {
      const [along, up] = [u.valToPos(r.S, 'x', true), u.valToPos(r.force, 'force', true)];
      const [x, y] = this.upright ? [up, along] : [along, up];
      ctx.strokeStyle = ctx.fillStyle = r.colour;
      ctx.lineWidth = (thin ? 1 : 2) * devicePixelRatio;
      ctx.beginPath();
      if (this.upright) ctx.moveTo(bbox.left, y);
      else ctx.moveTo(x, bbox.top + bbox.height);
      ctx.lineTo(x, y);
      ctx.stroke();
      ctx.beginPath();
      ctx.arc(x, y, (thin ? 1.6 : 3.2) * devicePixelRatio, 0, 2 * Math.PI);
      ctx.fill();
    }
    ctx.restore();
  }

  private mark(): void {
    const step = this.store.current;
    if (!step || !hasFields(step)) return;
    const fields = step.fields!;
    const { row } = this.store;
    const S = fields.S[row]!;
    for (const track of tracks) {
      const plot = this.plots.get(track.id);
      if (!plot) continue;
      const at = plot.valToPos(S, 'x');
      const seen = at >= 0 && at <= (this.upright ? plot.over.clientHeight : plot.over.clientWidth);
      // the other coordinate beside the plot, so that one line shows; uPlot hides both where `left` is negative
      plot.setCursor(!seen ? { left: -10, top: -10 } : this.upright ? { left: 0, top: at } : { left: at, top: -10 }, false);
      const values = track.series.map((series) =>
        h(
          'span',
          { 'data-field': series.field, 'data-value': String(fields[series.field][row]), style: `--tint: var(--${series.colour})` },
          `${series.label} ${this.units.number(quiet(fields[series.field][row], this.sizes.get(series.field) ?? 0), track.kind, 5)}`,
        ),
      );
      this.hosts.get(track.id)!.values.replaceChildren(...values);
    }
    this.element.setAttribute('aria-valuemin', String(fields.S[0]));
    this.element.setAttribute('aria-valuemax', String(fields.S[fields.S.length - 1]));
    this.element.setAttribute('aria-valuenow', String(S));
    const told = (['gap', 'pressure', 'F3'] as const).map((name) => {
      const kind = tracks.find((track) => track.series[0].field === name)!.kind;
      return `${name} ${this.units.text(fields[name][row], kind)}`;
    });
    this.element.setAttribute('aria-valuetext', `S = ${this.units.text(S, 'length')}, ${told.join(', ')}`);
  }

  private key(event: KeyboardEvent): void {
    const { store } = this;
    const stride = event.shiftKey ? 10 : 1;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => store.setRow(store.row - stride),
      ArrowDown: () => store.setRow(store.row - stride),
      ArrowRight: () => store.setRow(store.row + stride),
      ArrowUp: () => store.setRow(store.row + stride),
      Home: () => store.setRow(0),
      End: () => store.setRow(Infinity),
      PageUp: () => store.toContact(-1),
      PageDown: () => store.toContact(1),
      Escape: () => this.zoom(null),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }
}
