// SPDX-License-Identifier: Apache-2.0
// What glows on the stage: faces, fat lines and points, drawn over the surface.
import { BufferAttribute, BufferGeometry, Color, DoubleSide, Group, Mesh, MeshBasicMaterial, Points, PointsMaterial, type Vector3 } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { polygonTriangles } from './mesh_model';

export interface Marks {
  polygons?: readonly (readonly Vector3[])[];
  lines?: readonly Vector3[]; // pairs
  points?: readonly Vector3[];
}

export interface Look {
  color: Color;
  opacity?: number;
  width?: number; // pixels
  onTop?: boolean; // also where the surface hides it
}

/** The name of what filled() makes. */
export const FILLED = 'filled';

function flat(points: readonly Vector3[]): Float32Array {
  const numbers = new Float32Array(3 * points.length);
  points.forEach((p, i) => p.toArray(numbers, 3 * i));
  return numbers;
}

export function fatLines(pairs: readonly Vector3[] | Float32Array, look: Look): LineSegments2 {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(pairs instanceof Float32Array ? pairs : flat(pairs));
  const material = new LineMaterial({
    color: look.color,
    linewidth: look.width ?? 2.5,
    transparent: (look.opacity ?? 1) < 1 || look.onTop === true,
    opacity: look.opacity ?? 1,
    depthTest: look.onTop !== true,
    polygonOffset: true,
    polygonOffsetFactor: -2,
    polygonOffsetUnits: -2,
  });
  const lines = new LineSegments2(geometry, material);
  lines.renderOrder = look.onTop === true ? 3 : 1;
  lines.frustumCulled = false;
  return lines;
}

export function filled(polygons: readonly (readonly Vector3[])[], look: Look): Mesh {
  const points: Vector3[] = [];
  for (const outline of polygons) {
    for (const triangle of polygonTriangles(outline)) points.push(...triangle.map((k) => outline[k]!));
  }
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(flat(points), 3));
  const material = new MeshBasicMaterial({
    color: look.color,
    side: DoubleSide,
    transparent: true,
    opacity: look.opacity ?? 0.85,
    depthTest: look.onTop !== true,
    depthWrite: false,
    polygonOffset: true,
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -1,
  });
  const mesh = new Mesh(geometry, material);
  mesh.renderOrder = 2;
  mesh.name = FILLED;
  return mesh;
}

export function dots(points: readonly Vector3[], look: Look): Points {
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(flat(points), 3));
  const material = new PointsMaterial({ color: look.color, size: (look.width ?? 2.5) * 3, sizeAttenuation: false, depthTest: look.onTop !== true, transparent: true, opacity: look.opacity ?? 1 });
  const cloud = new Points(geometry, material);
  cloud.renderOrder = 4;
  return cloud;
}

export function marked(marks: Marks, look: Look): Group {
  const group = new Group();
  if (marks.polygons !== undefined && marks.polygons.length > 0) group.add(filled(marks.polygons, look));
  if (marks.lines !== undefined && marks.lines.length > 0) group.add(fatLines(marks.lines, look));
  if (marks.points !== undefined && marks.points.length > 0) group.add(dots(marks.points, look));
  return group;
}

/** Empties a group and frees what it has drawn with. */
export function clearGroup(group: Group): void {
  group.traverse((object) => {
    if (!(object instanceof Mesh || object instanceof Points)) return;
    (object.geometry as BufferGeometry).dispose();
    for (const material of [object.material].flat()) material.dispose();
  });
  group.clear();
}
