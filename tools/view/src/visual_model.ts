// SPDX-License-Identifier: Apache-2.0
// The mesh for the eye out of a graph's file (runtime/include/fdcg/visual.h), as a geometry with smooth normals and the colours of
// its vertices times those of its materials.
import { BufferAttribute, BufferGeometry } from 'three';
import type { GraphModel } from './graph_model';

const VERTEX_BYTES = 40;
const MATERIAL_BYTES = 96;

export interface Visual {
  geometry: BufferGeometry;
  materials: string[];
}

/** Undefined where the file has none. */
export function visualOf(model: GraphModel): Visual | undefined {
  const found = model.runtime.visual();
  if (found === undefined) return undefined;
  const { vertices, indices, materials } = found;
  const { origin } = model.runtime.header();
  const { centre, size } = model.frame;
  const count = vertices.byteLength / VERTEX_BYTES;
  const position = new Float32Array(3 * count);
  const normal = new Float32Array(3 * count);
  for (let v = 0; v < count; ++v) {
    const at = VERTEX_BYTES * v;
    for (let k = 0; k < 3; ++k) {
      position[3 * v + k] = (vertices.getFloat32(at + 4 * k, true) + origin[k]! - centre[k]!) / size;
      normal[3 * v + k] = vertices.getInt16(at + 16 + 2 * k, true) / 32767;
    }
  }
  // A vertex may serve two materials, so each corner of a triangle has its own colour.
  const corners = indices.length;
  const geometry = new BufferGeometry();
  const spread = { position: new Float32Array(3 * corners), normal: new Float32Array(3 * corners), faceColor: new Float32Array(3 * corners) };
  const names: string[] = [];
  for (let at = 0; at < materials.byteLength; at += MATERIAL_BYTES) {
    names.push(new TextDecoder().decode(new Uint8Array(materials.buffer, materials.byteOffset + at, 64)).split('\0')[0]!);
    const first = materials.getUint32(at + 80, true);
    const end = first + materials.getUint32(at + 84, true);
    for (let i = first; i < end; ++i) {
      const v = indices[i]!;
      spread.position.set(position.subarray(3 * v, 3 * v + 3), 3 * i);
      spread.normal.set(normal.subarray(3 * v, 3 * v + 3), 3 * i);
      for (let k = 0; k < 3; ++k) {
        const share = vertices.getUint16(VERTEX_BYTES * v + 32 + 2 * k, true) / 65535;
        spread.faceColor[3 * i + k] = share * materials.getFloat32(at + 64 + 4 * k, true);
      }
    }
  }
  for (const [name, values] of Object.entries(spread)) geometry.setAttribute(name, new BufferAttribute(values, 3));
  return { geometry, materials: names };
}
