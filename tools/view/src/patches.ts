// SPDX-License-Identifier: Apache-2.0
// Patches of a mesh: faces joined across edges of exactly two faces, after vertices at equal coordinates have become one.
import { eachSide } from './edges';
import type { MeshModel } from './mesh_model';

/** Of each point the first one at its coordinates. */
function welded(points: Float32Array): Uint32Array {
  const count = points.length / 3;
  const bits = new Uint32Array(Float32Array.from(points, (x) => x + 0).buffer); // -0 becomes 0
  let size = 16;
  while (size < 2 * count) size *= 2;
  const slots = new Int32Array(size).fill(-1);
  const first = new Uint32Array(count);
  for (let p = 0; p < count; ++p) {
    const [a, b, c] = [bits[3 * p]!, bits[3 * p + 1]!, bits[3 * p + 2]!];
    let hash = Math.imul(a ^ (a >>> 15), 0x9e3779b1) ^ Math.imul(b ^ (b >>> 13), 0x85ebca6b) ^ Math.imul(c ^ (c >>> 16), 0xc2b2ae35);
    let at = ((hash ^= hash >>> 15), hash & (size - 1));
    for (;;) {
      const known = slots[at]!;
      if (known < 0) {
        slots[at] = p;
        first[p] = p;
        break;
      }
      if (bits[3 * known] === a && bits[3 * known + 1] === b && bits[3 * known + 2] === c) {
        first[p] = known;
        break;
      }
      at = (at + 1) & (size - 1);
    }
  }
  return first;
}

export interface Patches {
  ofFace: Uint32Array;
  count: number;
}

export function patchesOf(model: MeshModel): Patches {
  const first = welded(model.points);
  const parent = Uint32Array.from({ length: model.faceCount }, (_, f) => f);
  const root = (f: number): number => {
    while (parent[f] !== f) f = parent[f] = parent[parent[f]!]!;
    return f;
  };
  const faces = new Int32Array(model.corners.length).fill(-1); // of an edge its first face
  const others = new Int32Array(model.corners.length).fill(-1); // its second; -2: it has more
  eachSide(model, first, (edge, isNew, f) => {
    if (isNew) faces[edge] = f;
    else others[edge] = others[edge] === -1 ? f : -2;
  });
  for (let at = 0; at < faces.length; ++at) if (others[at]! >= 0) parent[root(faces[at]!)] = root(others[at]!);
  const numbers = new Map<number, number>();
  const ofFace = Uint32Array.from(parent, (_, f) => {
    const of = root(f);
    const known = numbers.get(of);
    if (known !== undefined) return known;
    numbers.set(of, numbers.size);
    return numbers.size - 1;
  });
  return { ofFace, count: numbers.size };
}
