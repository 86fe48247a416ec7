// SPDX-License-Identifier: Apache-2.0
// A mesh as its file has it: polygons by the file's own numbers, and triangles to draw them.
import { BufferAttribute, BufferGeometry, ShapeUtils, Vector2, Vector3 } from 'three';
import { type Geometry, readArray } from './data';
import { eachSide } from './edges';
import { Frame } from './frame';

function words(bytes: Uint8Array<ArrayBuffer>): Uint32Array<ArrayBuffer> {
  return new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length >> 2);
}

export class MeshModel {
  readonly geometry = new BufferGeometry();
  /** Of each triangle its face. */
  readonly triangleFace: Uint32Array;
  private constructor(
    readonly frame: Frame,
    readonly points: Float32Array, // stage, may hold NaN
    readonly corners: Uint32Array,
    readonly faceStart: Uint32Array,
    readonly faceLines: Uint32Array | undefined,
    readonly pointLines: Uint32Array | undefined,
    readonly faceMaterials: Uint32Array | undefined,
  ) {
    const { index, faces } = this.triangulate();
    this.triangleFace = faces;
    const drawn = points.slice();
    for (let i = 0; i < drawn.length; ++i) if (!Number.isFinite(drawn[i]!)) drawn[i] = 0;
    this.geometry.setAttribute('position', new BufferAttribute(drawn, 3));
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }

  static async read(from: Geometry, metresPerUnit: number): Promise<MeshModel> {
    const optional = async (name: 'sizes' | 'face_lines' | 'point_lines' | 'face_materials'): Promise<Uint32Array | undefined> =>
      from[name] === undefined ? undefined : words(await readArray(from[name]));
    const pointBytes = await readArray(from.points);
    const points = new Float32Array(pointBytes.buffer, pointBytes.byteOffset, pointBytes.length >> 2);
    const corners = words(await readArray(from.corners));
    const sizes = await optional('sizes');
    const count = sizes?.length ?? corners.length / 3;
    const starts = new Uint32Array(count + 1);
    for (let f = 0; f < count; ++f) starts[f + 1] = starts[f]! + (sizes?.[f] ?? 3);
    const frame = new Frame(from.centre, from.size, metresPerUnit);
    return new MeshModel(frame, points, corners, starts, await optional('face_lines'), await optional('point_lines'), await optional('face_materials'));
  }

  get faceCount(): number {
    return this.faceStart.length - 1;
  }
  get pointCount(): number {
    return this.points.length / 3;
  }
  /** The corners of a face, by the file's numbers. */
  face(f: number): Uint32Array {
    return this.corners.subarray(this.faceStart[f] ?? 0, this.faceStart[f + 1] ?? 0);
  }
  point(p: number): Vector3 | undefined {
    const v = new Vector3(this.points[3 * p], this.points[3 * p + 1], this.points[3 * p + 2]);
    return Number.isFinite(v.x + v.y + v.z) ? v : undefined;
  }
  /** The faces at a point, in fans: of one fan are those that share an edge at it. */
  fans(p: number): number[][] {
    let fans: { faces: number[]; ends: Set<number> }[] = [];
    for (let f = 0; f < this.faceCount; ++f) {
      const way = this.face(f);
      const at = way.indexOf(p);
      if (at < 0) continue;
      const ends = [way[(at + 1) % way.length]!, way[(at + way.length - 1) % way.length]!];
      const joined = fans.filter((fan) => ends.some((end) => fan.ends.has(end)));
      fans = fans.filter((fan) => !joined.includes(fan));
      fans.push({ faces: [f, ...joined.flatMap((fan) => fan.faces)], ends: new Set([...ends, ...joined.flatMap((fan) => [...fan.ends])]) });
    }
    return fans.map((fan) => fan.faces);
  }
  /** The other corners of the faces at a point. */
  neighbours(p: number): number[] {
    const found = new Set<number>();
    for (let f = 0; f < this.faceCount; ++f) if (this.face(f).includes(p)) for (const corner of this.face(f)) found.add(corner);
    found.delete(p);
    return [...found];
  }
  /** A face's outline; empty where it has no place. */
  outline(f: number): Vector3[] {
    const way: Vector3[] = [];
    for (const corner of this.face(f)) {
      const p = this.point(corner);
      if (p === undefined) return [];
      way.push(p);
    }
    return way;
  }
  /** By Newell: twice the area, along the normal. */
  faceNormal(f: number): Vector3 {
    return newell(this.outline(f));
  }

  private triangulate(): { index: Uint32Array; faces: Uint32Array } {
    let most = 0;
    for (let f = 0; f < this.faceCount; ++f) most += Math.max(0, this.faceStart[f + 1]! - this.faceStart[f]! - 2);
    const faces = new Uint32Array(most);
    if (this.allTriangles() && this.pointsAreFinite() && this.cornersAreThere()) {
      for (let f = 0; f < most; ++f) faces[f] = f;
      return { index: this.corners.slice(), faces };
    }
    const index = new Uint32Array(3 * most);
    let count = 0;
    const put = (f: number, a: number, b: number, c: number): void => {
      index.set([a, b, c], 3 * count);
      faces[count++] = f;
    };
    for (let f = 0; f < this.faceCount; ++f) {
      const way = this.face(f);
      if (way.length === 3) {
        if (this.isDrawable(way[0]!) && this.isDrawable(way[1]!) && this.isDrawable(way[2]!)) put(f, way[0]!, way[1]!, way[2]!);
        continue;
      }
      const outline = this.outline(f);
      if (outline.length < 3) continue;
      for (const [a, b, c] of polygonTriangles(outline)) put(f, way[a]!, way[b]!, way[c]!);
    }
    return { index: index.slice(0, 3 * count), faces: faces.slice(0, count) };
  }
  private pointsAreFinite(): boolean {
    return this.points.every((x) => Number.isFinite(x));
  }
  private cornersAreThere(): boolean {
    return this.corners.every((p) => p < this.pointCount);
  }
  private allTriangles(): boolean {
    for (let f = 0; f < this.faceCount; ++f) if (this.faceStart[f + 1]! - this.faceStart[f]! !== 3) return false;
    return true;
  }
  private isDrawable(p: number): boolean {
    return Number.isFinite(this.points[3 * p]! + this.points[3 * p + 1]! + this.points[3 * p + 2]!);
  }

  /** Pairs of points, one for each edge of the file's faces. */
  edges(): Uint32Array {
    const pairs = new Uint32Array(2 * this.corners.length);
    let count = 0;
    eachSide(this, undefined, (_edge, isNew, _face, a, b) => {
      if (!isNew || !this.isDrawable(a) || !this.isDrawable(b)) return;
      pairs[count++] = a;
      pairs[count++] = b;
    });
    return pairs.slice(0, count);
  }
}

export function newell(outline: readonly Vector3[]): Vector3 {
  const sum = new Vector3();
  const across = new Vector3();
  outline.forEach((p, k) => sum.add(across.crossVectors(p, outline[(k + 1) % outline.length]!)));
  return sum;
}

/** Triangles of a polygon, by its corners' places: in its own plane, ears cut where it is not convex. */
export function polygonTriangles(outline: readonly Vector3[]): [number, number, number][] {
  const normal = newell(outline);
  const axis = Math.abs(normal.x) > Math.abs(normal.y) ? (Math.abs(normal.x) > Math.abs(normal.z) ? 'x' : 'z') : Math.abs(normal.y) > Math.abs(normal.z) ? 'y' : 'z';
  const flip = normal[axis] < 0;
  const flat = outline.map((p) => {
    const [u, v] = axis === 'x' ? [p.y, p.z] : axis === 'y' ? [p.z, p.x] : [p.x, p.y];
    return flip ? new Vector2(v, u) : new Vector2(u, v);
  });
  return ShapeUtils.triangulateShape(flat, []) as [number, number, number][];
}
