// Triangles of swept tubes and arrows. Vertices are relative to an origin near them (single precision on the card),
// the mesh is placed at that origin.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  Group,
  InstancedMesh,
  Matrix4,
  type Mesh,
  MeshBasicMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
  type Material,
} from 'three';

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

/** Arrows of constant thickness, one draw call for shafts and one for heads. */
export function arrows(list: Arrow[], thickness: number, origin: Vec): Group {
  const group = new Group();
  const head = 7 * thickness;
  const many = list.length > 200;
  const material = new MeshBasicMaterial({ depthTest: false, transparent: true });
  const shafts = new InstancedMesh(new CylinderGeometry(1, 1, 1, many ? 4 : 8, 1, true), material, list.length);
  const heads = new InstancedMesh(new ConeGeometry(1, 1, many ? 6 : 14), material, list.length);
  const turn = new Quaternion();
  const matrix = new Matrix4();
  const y = new Vector3(0, 1, 0);
  list.forEach((arrow, i) => {
    turn.setFromUnitVectors(y, new Vector3(...arrow.direction));
    const long = Math.max(arrow.length, 1.3 * head);
    const at = (back: number) => new Vector3(...sub(add(arrow.tip, arrow.direction, -back), origin));
    matrix.compose(at(0.5 * (long + head)), turn, new Vector3(thickness, long - head, thickness));
    shafts.setMatrixAt(i, matrix);
    matrix.compose(at(0.5 * head), turn, new Vector3(0.36 * head, head, 0.36 * head));
    heads.setMatrixAt(i, matrix);
    shafts.setColorAt(i, new Color(arrow.colour));
    heads.setColorAt(i, new Color(arrow.colour));
  });
  for (const mesh of [shafts, heads]) {
    mesh.frustumCulled = false;
    mesh.renderOrder = 5;
    group.add(mesh);
  }
  group.position.set(...origin);
  return group;
}

export function balls(list: { centre: Vec; colour: string }[], radius: number, material: Material, origin: Vec): InstancedMesh {
  const many = list.length > 200;
  const mesh = new InstancedMesh(new SphereGeometry(radius, many ? 6 : 20, many ? 5 : 14), material, list.length);
  list.forEach((ball, i) => {
    mesh.setMatrixAt(i, new Matrix4().makeTranslation(...sub(ball.centre, origin)));
    mesh.setColorAt(i, new Color(ball.colour));
  });
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
