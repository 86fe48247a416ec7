// SPDX-License-Identifier: Apache-2.0
// A coarse version of many triangles, to be drawn while the view moves: points are merged by the cells of a grid.
const CELLS = 128; // along the object's size: some 80,000 triangles are left of a closed surface

/** Of triangles over points in a frame of size 1 about the origin those that are left, over the same points. */
export function coarseIndex(points: ArrayLike<number>, index: Uint32Array): Uint32Array<ArrayBuffer> {
  const side = CELLS + 1;
  const first = new Int32Array(side ** 3).fill(-1); // of each cell the point that stands for it
  const merged = new Uint32Array(points.length / 3);
  const cell = (x: number): number => Math.min(CELLS, Math.max(0, Math.floor((x + 0.5) * CELLS)));
  for (let p = 0; p < merged.length; ++p) {
    const at = (cell(points[3 * p]!) * side + cell(points[3 * p + 1]!)) * side + cell(points[3 * p + 2]!);
    if (first[at]! < 0) first[at] = p;
    merged[p] = first[at]!;
  }
  const left = new Uint32Array(index.length);
  let count = 0;
  for (let i = 0; i < index.length; i += 3) {
    const a = merged[index[i]!]!;
    const b = merged[index[i + 1]!]!;
    const c = merged[index[i + 2]!]!;
    if (a === b || b === c || c === a) continue;
    left[count++] = a;
    left[count++] = b;
    left[count++] = c;
  }
  return left.slice(0, count);
}
