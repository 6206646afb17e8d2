// A frame with axes as SVG, for the drawings that are not functions of S: response curve and wall map.

import { s } from './dom';
import { format } from './units';

export interface Axis {
  low: number;
  high: number;
  factor: number; // shown = value * factor
  label: string;
  ticks?: number[]; // in shown values
}

export interface Chart {
  svg: SVGSVGElement;
  plot: SVGGElement; // clipped to the frame
  over: SVGGElement; // not clipped
  x: (value: number) => number;
  y: (value: number) => number;
  toX: (pixel: number) => number;
  toY: (pixel: number) => number;
  width: number;
  height: number;
}

const kLeft = 82;
const kRight = 14;
const kTop = 10;
const kBottom = 40;

export function ticks(low: number, high: number, about: number): number[] {
  const raw = (high - low) / Math.max(about, 1);
  if (!(raw > 0)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((v) => v >= raw)!;
  const out: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(Number((i * step).toPrecision(12)));
  return out;
}

export function widen([low, high]: [number, number], by = 0.06): [number, number] {
  const span = high - low || Math.abs(high) || 1;
  return [low - by * span, high + by * span];
}

export function extent(values: (number | null)[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const v of values) {
    if (v === null || !Number.isFinite(v)) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  return low <= high ? [low, high] : [0, 1];
}

let clips = 0;

/** As wide as the element that takes it. */
export function chart(host: HTMLElement, height: number, xAxis: Axis, yAxis: Axis, label: string): Chart {
  const width = Math.max(host.clientWidth, 300);
  const [w, hgt] = [width - kLeft - kRight, height - kTop - kBottom];
  const x = (v: number) => kLeft + ((v - xAxis.low) / (xAxis.high - xAxis.low)) * w;
  const y = (v: number) => kTop + hgt - ((v - yAxis.low) / (yAxis.high - yAxis.low)) * hgt;
  const clip = `clip${++clips}`;
  const plot = s('g', { 'clip-path': `url(#${clip})` });
  const over = s('g');
  const svg = s(
    'svg',
    { class: 'chart', viewBox: `0 0 ${width} ${height}`, width: '100%', role: 'img', 'aria-label': label },
    s('defs', {}, s('clipPath', { id: clip }, s('rect', { x: kLeft, y: kTop - 1, width: w, height: hgt + 2 }))),
  );
  const list = (axis: Axis, about: number) => axis.ticks ?? ticks(axis.low * axis.factor, axis.high * axis.factor, about);
  for (const t of list(xAxis, w / 90)) {
    const at = x(t / xAxis.factor);
    svg.append(
      s('line', { class: 'grid', x1: at, x2: at, y1: kTop, y2: kTop + hgt }),
      s('text', { x: at, y: kTop + hgt + 16, 'text-anchor': 'middle' }, format(t, 6)),
    );
  }
  for (const t of list(yAxis, hgt / 42)) {
    const at = y(t / yAxis.factor);
    svg.append(
      s('line', { class: 'grid', x1: kLeft, x2: kLeft + w, y1: at, y2: at }),
      s('text', { x: kLeft - 8, y: at + 4, 'text-anchor': 'end' }, format(t, 6)),
    );
  }
  svg.append(
    s('text', { class: 'axis', x: kLeft + w / 2, y: height - 6, 'text-anchor': 'middle' }, xAxis.label),
    s('text', { class: 'axis', x: 0, y: 0, 'text-anchor': 'middle', transform: `translate(13 ${kTop + hgt / 2}) rotate(-90)` }, yAxis.label),
    plot,
    over,
  );
  const toX = (pixel: number) => xAxis.low + ((pixel - kLeft) / w) * (xAxis.high - xAxis.low);
  const toY = (pixel: number) => yAxis.low + ((kTop + hgt - pixel) / hgt) * (yAxis.high - yAxis.low);
  return { svg, plot, over, x, y, toX, toY, width, height };
}

/** Now (once laid out), and whenever the width changes. */
export function onResize(element: HTMLElement, action: () => void): void {
  let width = -1;
  new ResizeObserver(() => {
    if (element.clientWidth === width || element.clientWidth === 0) return;
    width = element.clientWidth;
    action();
  }).observe(element);
}

/** Points to path data; a null breaks the line. */
export function path(points: ([number, number] | null)[]): string {
  let pen = 'M';
  let out = '';
  for (const p of points) {
    if (!p || !Number.isFinite(p[0] + p[1])) {
      pen = 'M';
      continue;
    }
    out += `${pen}${p[0].toFixed(1)} ${p[1].toFixed(1)}`;
    pen = 'L';
  }
  return out;
}

/** A mouse event in the units of the viewBox. */
export function inside(svg: SVGSVGElement, event: MouseEvent): [number, number] {
  const box = svg.getBoundingClientRect();
  const { width, height } = svg.viewBox.baseVal;
  return [((event.clientX - box.left) / box.width) * width, ((event.clientY - box.top) / box.height) * height];
}
