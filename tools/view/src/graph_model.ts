// SPDX-License-Identifier: Apache-2.0
// A graph's nodes and edges as arrays to draw, read from the runtime's records.
import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { Frame } from './frame';
import { NONE, type Runtime } from './runtime';

export interface BoxLevel {
  level: number;
  lines: Float32Array;
}

export class GraphModel {
  readonly frame: Frame;
  readonly geometry = new BufferGeometry();
  readonly triangleNode: Uint32Array;
  readonly corners: Float32Array; // stage
  readonly lines: Float32Array[] = []; // by type of connection: pairs of points
  readonly lineNumbers: Uint32Array[] = []; // by type: the connection of each pair
  readonly busyCorners: Vector3[] = [];
  readonly loops: Uint32Array; // corners of all nodes
  readonly loopStart: Uint32Array;

  /** `frame`: of the mesh that the graph was made from; else the graph's own. */
  constructor(
    readonly runtime: Runtime,
    frame?: Frame,
  ) {
    const header = runtime.header();
    const centre = header.low.map((low, k) => (low + header.high[k]!) / 2 + header.origin[k]!) as [number, number, number];
    const size = Math.max(...header.high.map((high, k) => high - header.low[k]!)) || 1;
    this.frame = frame ?? new Frame(centre, size, header.metresPerUnit);
    this.corners = this.readCorners();
    ({ loops: this.loops, starts: this.loopStart } = this.readLoops());
    this.triangleNode = this.makeTriangles();
    this.readLines();
  }

  /** Of a point in the file's local frame. */
  place(local: ArrayLike<number>): Vector3 {
    const { origin } = this.runtime.header();
    return this.frame.fromSource([local[0]! + origin[0], local[1]! + origin[1], local[2]! + origin[2]]);
  }
  corner(v: number): Vector3 {
    return new Vector3(this.corners[3 * v], this.corners[3 * v + 1], this.corners[3 * v + 2]);
  }
  outline(node: number): Vector3[] {
    return [...this.loops.subarray(this.loopStart[node], this.loopStart[node + 1])].map((v) => this.corner(v));
  }

  private readCorners(): Float32Array {
    const { corners: count, origin } = this.runtime.header();
    const places = new Float32Array(3 * count);
    for (let v = 0; v < count; ++v) {
      const { point, fan } = this.runtime.corner(v);
      for (let k = 0; k < 3; ++k) places[3 * v + k] = (point[k]! + origin[k]! - this.frame.centre[k]!) / this.frame.size;
      if (fan > 32) this.busyCorners.push(new Vector3().fromArray(places, 3 * v));
    }
    return places;
  }

  private readLoops(): { loops: Uint32Array; starts: Uint32Array } {
    const { nodes } = this.runtime.header();
    const loops: number[] = [];
    const starts = new Uint32Array(nodes + 1);
    for (let n = 0; n < nodes; ++n) {
      const { sides } = this.runtime.node(n);
      for (let k = 0; k < sides; ++k) loops.push(this.runtime.side(n, k).corner);
      starts[n + 1] = loops.length;
    }
    return { loops: Uint32Array.from(loops), starts };
  }

  // Nodes are convex: fans of triangles, each with corners of its own, so that a node has a colour.
  private makeTriangles(): Uint32Array {
    const nodes = this.loopStart.length - 1;
    const triangles = this.loops.length - 2 * nodes;
    const positions = new Float32Array(9 * triangles);
    const owners = new Uint32Array(triangles);
    let t = 0;
    for (let n = 0; n < nodes; ++n) {
      const first = this.loopStart[n]!;
      const last = this.loopStart[n + 1]!;
      for (let k = first + 1; k + 1 < last; ++k, ++t) {
        owners[t] = n;
        [this.loops[first]!, this.loops[k]!, this.loops[k + 1]!].forEach((v, at) => positions.set(this.corners.subarray(3 * v, 3 * v + 3), 9 * t + 3 * at));
      }
    }
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('faceColor', new BufferAttribute(new Float32Array(positions.length), 3));
    return owners;
  }

  /** Of each point of the geometry its corner, in the order of makeTriangles(). */
  triangleCorners(): Uint32Array {
    const corners = new Uint32Array(3 * this.triangleNode.length);
    let at = 0;
    for (let n = 0; n + 1 < this.loopStart.length; ++n) {
      const first = this.loopStart[n]!;
      for (let k = first + 1; k + 1 < this.loopStart[n + 1]!; ++k) for (const corner of [first, k, k + 1]) corners[at++] = this.loops[corner]!;
    }
    return corners;
  }

  private readLines(): void {
    const { types, connections } = this.runtime.header();
    const filled = [0, 0, 0, 0];
    for (const count of types) {
      this.lines.push(new Float32Array(6 * count));
      this.lineNumbers.push(new Uint32Array(count));
    }
    for (let c = 0; c < connections; ++c) {
      const edge = this.runtime.connection(c);
      const at = filled[edge.type]!++;
      this.lineNumbers[edge.type]![at] = c;
      edge.corners.forEach((v, end) => this.lines[edge.type]!.set(this.corners.subarray(3 * v, 3 * v + 3), 6 * at + 3 * end));
    }
  }

  /** Colours by node: `colorOf` gives red, green and blue, linear. */
  paint(colorOf: (node: number) => readonly [number, number, number]): void {
    const colors = this.geometry.getAttribute('faceColor') as BufferAttribute;
    for (let t = 0; t < this.triangleNode.length; ++t) {
      const [r, g, b] = colorOf(this.triangleNode[t]!);
      for (let k = 0; k < 3; ++k) colors.setXYZ(3 * t + k, r, g, b);
    }
    colors.needsUpdate = true;
  }

  /** The boxes of one level of the hierarchy (schemas/fdcg-v1.md), root first. Empty where the file has none. */
  boxes(): BoxLevel[] {
    const bytes = this.runtime.bytes();
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const table = Array.from({ length: view.getUint32(28, true) }, (_, i) => 256 + 40 * i);
    const section = table.find((at) => view.getUint32(at, true) === 7);
    if (section === undefined) return [];
    const start = Number(view.getBigUint64(section + 8, true));
    const sizes: number[] = [];
    for (let items = Math.ceil(this.runtime.header().nodes / 4); ; items = sizes[0]!) {
      sizes.unshift(Math.ceil(items / 8));
      if (sizes[0] === 1) break;
    }
    const unit = 2 ** Math.floor(Math.log2(this.runtime.header().extent));
    let record = 0;
    return sizes.map((count, level) => {
      const lines: number[] = [];
      for (let i = 0; i < count; ++i, ++record) this.boxesOf(view, start + 64 * record, unit, lines);
      return { level, lines: Float32Array.from(lines) };
    });
  }

  private boxesOf(view: DataView, at: number, unit: number, lines: number[]): void {
    for (let j = 0; j < 8; ++j) {
      const ends = [0, 1, 2].map((axis) => {
        const origin = view.getFloat32(at + 4 * axis, true);
        const cell = 2 ** (view.getUint8(at + 12 + axis) - 127);
        return [origin + cell * view.getUint8(at + 16 + 8 * axis + j), origin + cell * view.getUint8(at + 40 + 8 * axis + j)].map((x) => x * unit);
      });
      if (ends.some(([low, high]) => low! > high!)) continue;
      const places = Array.from({ length: 8 }, (_, k) => this.place([ends[0]![k & 1]!, ends[1]![(k >> 1) & 1]!, ends[2]![k >> 2]!]));
      for (const [a, b] of [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]] as const)
        lines.push(...places[a]!.toArray(), ...places[b]!.toArray());
    }
  }

  /** The edge or corner of the node that a point on it is near to, within `radius`; else the node. */
  featureAt(node: number, point: Vector3, radius: number): { kind: 'node' | 'connection' | 'corner'; number: number } {
    const outline = this.outline(node);
    for (let k = 0; k < outline.length; ++k) {
      if (outline[k]!.distanceTo(point) < radius) return { kind: 'corner', number: this.loops[this.loopStart[node]! + k]! };
    }
    for (let k = 0; k < outline.length; ++k) {
      const a = outline[k]!;
      const along = outline[(k + 1) % outline.length]!.clone().sub(a);
      const share = Math.min(1, Math.max(0, point.clone().sub(a).dot(along) / along.lengthSq()));
      if (a.addScaledVector(along, share).distanceTo(point) < radius) return { kind: 'connection', number: this.runtime.side(node, k).connection };
    }
    return { kind: 'node', number: node };
  }

  hasBeyond(node: number, side: number): boolean {
    return this.runtime.side(node, side).across !== NONE;
  }
}
