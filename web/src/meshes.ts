// Triangles of swept tubes and arrows. Vertices are relative to an origin near them (single precision on the card),
// the mesh is placed at that origin.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  type Group,
  Matrix3,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';

import { add, cross, scaled, sub, unit, type Vec } from './geometry';

/** Rings around centres, in the plane of two unit vectors each, swept to a tube. */
export function sweep(rings: { centre: Vec; a: Vec; b: Vec; radius: number }[], around: number, origin: Vec): BufferGeometry {
  const position = new Float32Array(rings.length * around * 3);
  const normal = new Float32Array(position.length);
  const index = new Uint32Array(Math.max(rings.length - 1, 0) * around * 6);
  const cosine = Array.from({ length: around }, (_, k) => Math.cos((2 * Math.PI * k) / around));
  const sine = Array.from({ length: around }, (_, k) => Math.sin((2 * Math.PI * k) / around));
  let at = 0;
  for (const { centre, a, b, radius } of rings) {
    const c = sub(centre, origin);
    for (let k = 0; k < around; ++k) {
      for (let d = 0; d < 3; ++d) {
        const n = cosine[k] * a[d] + sine[k] * b[d];
        normal[at] = n;
        position[at++] = c[d] + radius * n;
      }
    }
  }
  at = 0;
  for (let i = 0; i + 1 < rings.length; ++i) {
    for (let k = 0; k < around; ++k) {
      const [p, q] = [i * around + k, i * around + ((k + 1) % around)];
      index.set([p, q, q + around, p, q + around, p + around], at);
      at += 6;
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('normal', new BufferAttribute(normal, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

/** The same geometry in one colour, to be merged with others. */
export function tinted(geometry: BufferGeometry, colour: string): BufferGeometry {
  const { r, g, b } = new Color(colour);
  const count = geometry.getAttribute('position').count;
  const values = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) values.set([r, g, b], 3 * i);
  geometry.setAttribute('color', new BufferAttribute(values, 3));
  return geometry;
}

/** A curve as rings with a frame carried along without twist. */
export function ringsAlong(points: Vec[], radius: number): { centre: Vec; a: Vec; b: Vec; radius: number }[] {
  const out: { centre: Vec; a: Vec; b: Vec; radius: number }[] = [];
  let a: Vec = [0, 0, 0];
  for (let i = 0; i < points.length; ++i) {
    const t = unit(sub(points[Math.min(i + 1, points.length - 1)], points[Math.max(i - 1, 0)]));
    if (i === 0) a = Math.abs(t[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    const b = unit(cross(t, a), [0, 1, 0]);
    a = cross(b, t);
    out.push({ centre: points[i], a, b, radius });
  }
  return out;
}

export interface Arrow {
  tip: Vec;
  direction: Vec; // unit
  length: number;
  colour: string;
}

/** Copies of a small shape in one geometry, each in its place and colour. Not instanced: without a graphics card every
 * instance is a draw of its own, and a thousand contacts take seconds. */
function copies(shape: BufferGeometry, places: Matrix4[], colours: string[]): BufferGeometry {
  const [from, normals, corners] = [shape.getAttribute('position'), shape.getAttribute('normal'), shape.getIndex()!];
  const [count, width] = [from.count, corners.count];
  const position = new Float32Array(3 * count * places.length);
  const normal = new Float32Array(position.length);
  const tint = new Float32Array(position.length);
  const index = new Uint32Array(width * places.length);
  const [at, turned, colour, turn] = [new Vector3(), new Vector3(), new Color(), new Matrix3()];
  places.forEach((place, i) => {
    turn.getNormalMatrix(place);
    colour.set(colours[i]);
    for (let k = 0; k < count; ++k) {
      at.fromBufferAttribute(from, k).applyMatrix4(place).toArray(position, 3 * (i * count + k));
      turned.fromBufferAttribute(normals, k).applyMatrix3(turn).normalize().toArray(normal, 3 * (i * count + k));
      colour.toArray(tint, 3 * (i * count + k));
    }
    for (let k = 0; k < width; ++k) index[i * width + k] = i * count + corners.getX(k);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setAttribute('normal', new BufferAttribute(normal, 3));
  geometry.setAttribute('color', new BufferAttribute(tint, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

/** Arrows of constant thickness in one draw call, shafts before heads. */
export function arrows(list: Arrow[], thickness: number, origin: Vec): Mesh {
  const head = 7 * thickness;
  const many = list.length > 200;
  const shafts: Matrix4[] = [];
  const heads: Matrix4[] = [];
  const turn = new Quaternion();
  const y = new Vector3(0, 1, 0);
  for (const arrow of list) {
    turn.setFromUnitVectors(y, new Vector3(...arrow.direction));
    const long = Math.max(arrow.length, 1.3 * head);
    const at = (back: number) => new Vector3(...sub(add(arrow.tip, arrow.direction, -back), origin));
    shafts.push(new Matrix4().compose(at(0.5 * (long + head)), turn, new Vector3(thickness, long - head, thickness)));
    heads.push(new Matrix4().compose(at(0.5 * head), turn, new Vector3(0.36 * head, head, 0.36 * head)));
  }
  const colours = list.map((arrow) => arrow.colour);
  const geometry = mergeGeometries([
    copies(new CylinderGeometry(1, 1, 1, many ? 4 : 8, 1, true), shafts, colours),
    copies(new ConeGeometry(1, 1, many ? 6 : 14), heads, colours),
  ]);
  const mesh = new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true, depthTest: false, transparent: true }));
  mesh.frustumCulled = false;
  mesh.renderOrder = 5;
  mesh.position.set(...origin);
  return mesh;
}

export function balls(list: { centre: Vec; colour: string }[], radius: number, origin: Vec): Mesh {
  const many = list.length > 200;
  const places = list.map((ball) => new Matrix4().makeTranslation(...sub(ball.centre, origin)));
  const shape = new SphereGeometry(radius, many ? 6 : 20, many ? 5 : 14);
  const mesh = new Mesh(copies(shape, places, list.map((ball) => ball.colour)), new MeshLambertMaterial({ vertexColors: true }));
  mesh.frustumCulled = false;
  mesh.position.set(...origin);
  return mesh;
}

/** A sheet from the rod outwards whose height is given at each point: the pressure of a line contact. */
export function sheet(feet: Vec[], directions: Vec[], heights: number[], origin: Vec): BufferGeometry {
  const position = new Float32Array(feet.length * 6);
  const index: number[] = [];
  feet.forEach((foot, i) => {
    const low = sub(foot, origin);
    position.set([...low, ...add(low, scaled(directions[i], heights[i]))], 6 * i);
    if (i > 0) index.push(2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 2, 2 * i + 1, 2 * i - 1);
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(position, 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(index), 1));
  return geometry;
}

/** Out of the scene, and its buffers off the card. */
export function dispose(group: Group): void {
  group.removeFromParent();
  group.traverse((object) => {
    const mesh = object as Mesh;
    mesh.geometry?.dispose();
    for (const material of mesh.material ? [mesh.material].flat() : []) material.dispose();
  });
}
