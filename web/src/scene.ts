// The rod in its tube in three dimensions. Drawn on demand only; lines, balls and arrows keep their size on the screen.
// The projection is parallel, so the scale bar holds everywhere in the picture.

import {
  BackSide,
  type BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  FrontSide,
  Group,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  OrthographicCamera,
  Scene as ThreeScene,
  SphereGeometry,
  TorusGeometry,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';

import { h, onceAFrame } from './dom';
import { add, scaled, type Geometry, type Vec } from './geometry';
import { marksOf } from './marks';
import { arrows, balls, dispose, ringsAlong, sheet, sweep, tinted, type Arrow } from './meshes';
import { hasFields } from './result';
import type { Store } from './store';
import { colour } from './theme';

export type Wall = 'translucent' | 'cut' | 'none';

const kArrow = 74; // pixels of the largest reaction
const kSheet = 46; // pixels of the largest pressure
const kRodPoints = 2000; // of the rod as drawn: about 40 000 triangles
const kMany = 200; // contacts

export class Scene {
  factor: number;
  wall: Wall = 'translucent';
  private readonly renderer: WebGLRenderer;
  private readonly scene = new ThreeScene();
  private readonly camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
  private readonly controls: OrbitControls;
  private readonly light = new DirectionalLight(0xffffff, 1.9);
  private readonly labels = h('div', { class: 'labels', 'aria-hidden': 'true' });
  private readonly bar = h('div', { class: 'scale-bar' });
  private group = new Group();
  private marker = new Group();
  private builtAt = 0; // units per pixel when built
  private rodPoints: Vec[] = [];
  private readonly draw = onceAFrame(() => this.awake && this.render());
  private awake = false; // the page is painted first, the picture then
  private rebuildTimer = 0;
  private stale = false; // meshes are made when next drawn
  private readonly plain: boolean; // so much to draw that a machine without a graphics card would wait

  /** Throws where there is no WebGL. */
  constructor(
    private readonly host: HTMLElement,
    private readonly geometry: Geometry,
    private readonly store: Store,
    private readonly lengthText: (value: number) => string,
  ) {
    this.factor = geometry.factors().start;
    // Kept for printing; smoothed unless there is too much to draw.
    this.plain = store.result.steps.some((step) => step.contacts.length > kMany);
    const antialias = !this.plain;
    const look = { antialias, alpha: true, preserveDrawingBuffer: true };
    const canvas = h('canvas');
    const context = canvas.getContext('webgl2', look) as WebGL2RenderingContext | null; // asked for here: three would complain on the console
    if (!context) throw new Error('no WebGL');
    this.renderer = new WebGLRenderer({ canvas, context: context as unknown as WebGLRenderingContext, ...look });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    host.append(this.renderer.domElement, this.labels, this.bar);
    this.renderer.domElement.setAttribute('aria-hidden', 'true');
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    // The wheel scrolls the page until the picture is clicked, a finger scrolls it up and down.
    this.controls.enableZoom = false;
    host.addEventListener('pointerdown', () => host.focus({ preventScroll: true }));
    host.addEventListener('focus', () => (this.controls.enableZoom = true));
    host.addEventListener('blur', () => (this.controls.enableZoom = false));
    canvas.style.touchAction = 'pan-y';
    this.scene.add(new HemisphereLight(0xffffff, 0x8894a0, 1.7), this.camera, this.group, this.marker);
    this.camera.add(this.light);
    this.light.position.set(-0.6, 0.9, 1);
    this.controls.addEventListener('change', () => this.moved());
    this.home();
    let width = 0;
    new ResizeObserver(() => {
      if (host.clientWidth !== width) this.resize();
      width = host.clientWidth;
    }).observe(host);
    host.addEventListener('pointermove', (event) => event.buttons === 0 && this.point(event));
    host.addEventListener('keydown', (event) => this.key(event));
    store.listen((what) => {
      if (what === 'row') this.mark();
      else this.build();
    });
    requestAnimationFrame(() =>
      setTimeout(() => {
        this.awake = true;
        this.draw();
      }),
    );
  }

  /** For tests: draw calls and triangles of the last frame. */
  get drawn(): { calls: number; triangles: number } {
    return { calls: this.renderer.info.render.calls, triangles: this.renderer.info.render.triangles };
  }

  setFactor(factor: number): void {
    this.factor = factor;
    this.build();
  }
  setWall(wall: Wall): void {
    this.wall = wall;
    this.build();
  }

  /** The whole tube, broadside. */
  home(tilt = 0.35): void {
    const { size } = this.geometry;
    const basis = this.geometry.view(tilt);
    const g = this.geometry;
    let low = [Infinity, Infinity];
    let high = [-Infinity, -Infinity];
    for (let i = 0; i < g.tube.S.length; ++i) {
      const section = g.sample(i);
      const r = g.wallRadius(section, this.factor);
      [basis.right, basis.up].forEach((d, k) => {
        const at = section.R.reduce((sum, v, j) => sum + (v - g.centre[j]) * d[j], 0);
        low[k] = Math.min(low[k], at - r);
        high[k] = Math.max(high[k], at + r);
      });
    }
    const centre = add(scaled(basis.right, 0.5 * (low[0] + high[0])), basis.up, 0.5 * (low[1] + high[1]));
    this.camera.up.set(...this.geometry.view(0).up);
    this.controls.target.set(...centre);
    this.camera.position.set(...add(centre, basis.toEye, 4 * size));
    this.camera.near = 0.01 * size;
    this.camera.far = 8 * size;
    this.extent = [high[0] - low[0], high[1] - low[1]];
    this.fit();
  }
  private extent = [1, 1];
  private width = 1;
  private height = 1;

  private fit([width, height] = [this.host.clientWidth, this.host.clientHeight]): void {
    this.width = width;
    this.height = height;
    if (width === 0 || height === 0) return;
    const margin = 1.24 * kArrow;
    const perPixel = Math.max(this.extent[0] / (width - margin), this.extent[1] / (height - margin));
    this.camera.zoom = 1;
    this.camera.left = -0.5 * width * perPixel;
    this.camera.right = -this.camera.left;
    this.camera.top = 0.5 * height * perPixel;
    this.camera.bottom = -this.camera.top;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.build();
  }

  private resize(): void {
    const width = this.host.clientWidth;
    if (width === 0) return;
    const height = this.heightFor(width);
    this.host.style.height = `${height}px`;
    this.renderer.setSize(width, height);
    this.fit();
  }

  private get perPixel(): number {
    return (this.camera.right - this.camera.left) / this.camera.zoom / Math.max(this.width, 1);
  }

  private moved(): void {
    if (Math.abs(Math.log(this.perPixel / this.builtAt)) > 0.02) {
      clearTimeout(this.rebuildTimer);
      this.rebuildTimer = window.setTimeout(() => this.build(), 60);
    }
    this.draw();
  }

  private relative(p: Vec): Vec {
    const c = this.geometry.centre;
    return [p[0] - c[0], p[1] - c[1], p[2] - c[2]];
  }

  private rodRadius(): number {
    return Math.max(this.geometry.rodRadius * this.factor, 1.4 * this.perPixel);
  }
  private wallRadius(section: { S: number; R: Vec; D1: Vec; D2: Vec; clearance: number }): number {
    return Math.max(this.geometry.wallRadius(section, this.factor), this.geometry.sign > 0 ? 1.5 * this.rodRadius() : 0);
  }

  private build(): void {
    this.stale = true;
    this.draw();
  }

  private rebuild(): void {
    this.stale = false;
    const g = this.geometry;
    this.builtAt = this.perPixel;
    dispose(this.group);
    const group = (this.group = new Group());
    this.scene.add(group);
    const target = this.controls.target;
    const origin: Vec = [target.x, target.y, target.z];
    const put = (mesh: Mesh, order = 0) => {
      mesh.position.set(...origin);
      mesh.frustumCulled = false;
      mesh.renderOrder = order;
      group.add(mesh);
      return mesh;
    };

    // the wall: at most about 50 000 triangles
    const n = g.tube.S.length;
    const sections = Math.min(n, this.plain ? 500 : 1000);
    const rings = [];
    for (let i = 0; i < sections; ++i) {
      const section = g.sample(Math.round((i * (n - 1)) / (sections - 1)));
      rings.push({ centre: this.relative(section.R), a: section.D1, b: section.D2, radius: this.wallRadius(section) });
    }
    if (this.wall !== 'none') {
      const swept = sweep(rings, this.plain ? 16 : sections > 600 ? 20 : 40, origin);
      const wallColour = new Color(colour('wall'));
      if (g.sign < 0) {
        put(new Mesh(swept, new MeshLambertMaterial({ color: wallColour, transparent: this.wall === 'translucent', opacity: this.wall === 'cut' ? 1 : 0.75 })), -2);
      } else if (this.wall === 'cut') {
        put(new Mesh(swept, new MeshLambertMaterial({ color: wallColour, side: BackSide })), -2);
      } else {
        const glass = (side: typeof FrontSide | typeof BackSide, opacity: number) =>
          new MeshLambertMaterial({ color: wallColour, side, transparent: true, opacity, depthWrite: false });
        put(new Mesh(swept, glass(BackSide, 0.34)), -2);
        put(new Mesh(swept, glass(FrontSide, 0.16)), 3);
      }
      for (const ring of [rings[0], rings[rings.length - 1]]) {
        const rim = Array.from({ length: 65 }, (_, k): Vec => {
          const t = (2 * Math.PI * k) / 64;
          return add(add(ring.centre, ring.a, ring.radius * Math.cos(t)), ring.b, ring.radius * Math.sin(t));
        });
        put(new Mesh(sweep(ringsAlong(rim, 0.7 * this.perPixel), 6, origin), new MeshBasicMaterial({ color: wallColour })), 0);
      }
    }

    const step = this.store.current;
    this.rodPoints = [];
    if (step && hasFields(step)) {
      const fields = step.fields!;
      this.rodPoints = fields.S.map((_, row) => this.relative(g.rod(step, row, this.factor)));
      const radius = this.rodRadius();
      const every = Math.ceil(this.rodPoints.length / kRodPoints);
      const around = this.rodPoints.length > 1500 ? 8 : 18;
      const shown = this.rodPoints.filter((p, row) => (row % every === 0 || row === this.rodPoints.length - 1) && p.every(Number.isFinite));
      const rod = sweep(ringsAlong(shown, radius), around, origin);
      put(new Mesh(rod, new MeshLambertMaterial({ color: colour('rod') })), 0);

      const marks = marksOf(step, g);
      const pixels = this.perPixel;
      const most = Math.max(0, ...step.contacts.map((c) => c.pressure_max ?? 0));
      const coats: BufferGeometry[] = [];
      const sheets: BufferGeometry[] = [];
      for (const line of marks.lines) {
        const rows = line.rows.filter((row) => this.rodPoints[row].every(Number.isFinite));
        if (rows.length < 2) continue;
        const path = rows.map((row) => this.rodPoints[row]);
        coats.push(tinted(sweep(ringsAlong(path, Math.max(1.18 * radius, radius + 0.8 * pixels)), around, origin), line.colour));
        const outward = rows.map((row) => g.outward(step, row));
        const height = rows.map((row) => (most > 0 ? (Math.max(fields.pressure[row] ?? 0, 0) / most) * kSheet * pixels : 0));
        sheets.push(tinted(sheet(path.map((p, i) => add(p, outward[i], radius)), outward, height, origin), line.colour));
      }
      if (coats.length) {
        put(new Mesh(mergeGeometries(coats), new MeshLambertMaterial({ vertexColors: true })), 1);
        const glass = { vertexColors: true, transparent: true, opacity: 0.42, side: DoubleSide, depthWrite: false };
        put(new Mesh(mergeGeometries(sheets), new MeshBasicMaterial(glass)), 2);
      }
      const at = (S: number, angle: number) => this.relative(g.touching(S, angle, this.factor));
      if (marks.points.length)
        group.add(
          balls(
            marks.points.map((p) => ({ centre: at(p.S, p.angle), colour: p.colour })),
            Math.max(1.5 * radius, radius + 2.2 * pixels),
            origin,
          ),
        );
      const list: Arrow[] = marks.reactions.map((r) => ({
        tip: add(at(r.S, r.angle), r.push, -radius),
        direction: r.push,
        length: r.share * kArrow * pixels,
        colour: r.colour,
      }));
      if (list.length) group.add(arrows(list, pixels * (list.length > 200 ? 0.8 : 1.25), origin));
    }
    this.mark();
  }

  // The marker: a ring around the wall and a ball on the rod.
  private mark(): void {
    dispose(this.marker);
    this.marker = new Group();
    this.scene.add(this.marker);
    const here = this.rodPoints[this.store.row];
    if (here && here.every(Number.isFinite)) {
      const section = this.geometry.at(this.store.place);
      const material = new MeshBasicMaterial({ color: colour('marker'), depthTest: false, transparent: true });
      const ball = new Mesh(new SphereGeometry(4.5 * this.perPixel, 20, 14), material);
      ball.position.set(...here);
      const wallRadius = Math.max(this.wallRadius(section), 9 * this.perPixel);
      const ring = new Mesh(new TorusGeometry(wallRadius, 0.9 * this.perPixel, 6, 64), material);
      const d3 = new Vector3(...section.D1).cross(new Vector3(...section.D2));
      ring.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), d3.normalize());
      ring.position.set(...this.relative(section.R));
      for (const mesh of [ring, ball]) {
        mesh.renderOrder = 6;
        mesh.frustumCulled = false;
      }
      this.marker.add(ring, ball);
    }
    this.draw();
  }

  private project(p: Vec): [number, number] {
    const v = new Vector3(...p).project(this.camera);
    return [(0.5 + 0.5 * v.x) * this.width, (0.5 - 0.5 * v.y) * this.height];
  }

  /** Height that leaves little empty space around the whole tube. */
  heightFor(width: number): number {
    const margin = 1.24 * kArrow;
    return Math.round(Math.min(Math.max((width - margin) * (this.extent[1] / this.extent[0]) + margin, 340), 540));
  }

  /** At once; for printing with a width of its own. */
  printAt(width: number): void {
    this.host.style.height = `${this.heightFor(width)}px`;
    this.renderer.setSize(width, this.heightFor(width));
    this.fit([width, this.heightFor(width)]);
    this.stale = true;
    this.render();
  }
  afterPrint(): void {
    this.resize();
  }

  /** Where a row of the fields is in the picture, for tests. */
  pixelOf(row: number): [number, number] {
    return this.project(this.rodPoints[row]);
  }

  private render(): void {
    if (this.host.clientWidth === 0) return;
    if (this.stale) this.rebuild();
    this.renderer.render(this.scene, this.camera);
    const S = this.geometry.tube.S;
    const label = (text: string, section: { R: Vec }, kind = '') => {
      const [x, y] = this.project(this.relative(section.R));
      const inside = x > 0 && y > 0 && x < this.width && y < this.height;
      const beside = kind === '' && x > this.width - 90 ? 'flip' : kind;
      return inside ? h('span', { class: beside, style: `left:${x.toFixed(0)}px;top:${y.toFixed(0)}px` }, text) : null;
    };
    const ends = [label('S = 0', this.geometry.sample(0)), label(this.lengthText(S[S.length - 1]), this.geometry.sample(S.length - 1))];
    const here = this.rodPoints.length ? label(this.lengthText(this.store.place), this.geometry.at(this.store.place), 'here') : null;
    this.labels.replaceChildren(...[...ends, here].filter((e): e is HTMLSpanElement => !!e));
    const most = 130 * this.perPixel;
    const power = 10 ** Math.floor(Math.log10(most));
    const round = [5, 2, 1].map((k) => k * power).find((v) => v <= most) ?? power;
    this.bar.style.width = `${(round / this.perPixel).toFixed(1)}px`;
    this.bar.textContent = this.lengthText(Number(round.toPrecision(3))).replace('S = ', '');
  }

  private point(event: PointerEvent): void {
    const box = this.host.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    let best = -1;
    let distance = 26 ** 2;
    this.rodPoints.forEach((p, row) => {
      const [px, py] = this.project(p);
      const d = (px - x) ** 2 + (py - y) ** 2;
      if (d < distance) [best, distance] = [row, d];
    });
    if (best >= 0) this.store.setRow(best);
  }

  private key(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const turn = turns[event.key];
    if (turn) {
      const offset = this.camera.position.clone().sub(this.controls.target);
      const up = this.camera.up.clone().normalize();
      offset.applyAxisAngle(up, -0.12 * turn[0]);
      const side = new Vector3().crossVectors(up, offset).normalize();
      const tilted = offset.clone().applyAxisAngle(side, -0.12 * turn[1]);
      if (Math.abs(tilted.clone().normalize().dot(up)) < 0.995) offset.copy(tilted);
      this.camera.position.copy(this.controls.target).add(offset);
    } else if (event.key === '+' || event.key === '=' || event.key === '-') {
      this.camera.zoom *= event.key === '-' ? 1 / 1.2 : 1.2;
      this.camera.updateProjectionMatrix();
    } else if (event.key === '0') {
      this.home();
    } else {
      return;
    }
    event.preventDefault();
    this.controls.update();
    this.moved();
  }
}
