// SPDX-License-Identifier: Apache-2.0
// A coarse version of many triangles, to be drawn while the view moves: points are merged by the cells of a grid.
const PER_AREA = 2.2; // triangles left of a smooth surface, by its area in sides of cells
const MOST_CELLS = 8e6;
const FINEST = 2048; // cells along the object's size

type Points = ArrayLike<number>;

/** The sum of the triangles' areas. */
function areaOf(points: Points, index: ArrayLike<number>): number {
  let twice = 0;
  for (let i = 0; i < index.length; i += 3) {
    const [a, b, c] = [3 * index[i]!, 3 * index[i + 1]!, 3 * index[i + 2]!];
    const [ux, uy, uz] = [points[b]! - points[a]!, points[b + 1]! - points[a + 1]!, points[b + 2]! - points[a + 2]!];
    const [vx, vy, vz] = [points[c]! - points[a]!, points[c + 1]! - points[a + 1]!, points[c + 2]! - points[a + 2]!];
    twice += Math.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2);
  }
  return twice / 2;
}

function boxOf(points: Points): { low: number[]; size: number[] } {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const x = points[i + k]!;
      if (x < low[k]!) low[k] = x;
      if (x > high[k]!) high[k] = x;
    }
  }
  return { low, size: high.map((x, k) => x - low[k]!) };
}

/** Of each point the first one in its cell; `perUnit` cells along 1. */
function merged(points: Points, perUnit: number): Uint32Array {
  const { low, size } = boxOf(points);
  const [nx, ny, nz] = size.map((x) => Math.floor(x * perUnit) + 1) as [number, number, number];
  const first = new Int32Array(nx * ny * nz).fill(-1);
  const of = new Uint32Array(points.length / 3);
  for (let p = 0; p < of.length; ++p) {
    const [x, y, z] = [0, 1, 2].map((k) => Math.floor((points[3 * p + k]! - low[k]!) * perUnit)) as [number, number, number];
    const at = (x * ny + y) * nz + z;
    if (first[at]! < 0) first[at] = p;
    of[p] = first[at]!;
  }
  return of;
}

/** Of triangles over points, in a frame where the object's size is 1, about as many as wanted, over the same points. */
export function coarseIndex(points: Points, index: ArrayLike<number>, wanted: number): Uint32Array<ArrayBuffer> {
  const { size } = boxOf(points);
  let perUnit = Math.min(FINEST, Math.sqrt(wanted / (PER_AREA * Math.max(areaOf(points, index), 1e-9))));
  while (size.reduce((cells, x) => cells * (Math.floor(x * perUnit) + 1), 1) > MOST_CELLS) perUnit *= 0.9;
  const of = merged(points, perUnit);
  const left = new Uint32Array(index.length);
  let count = 0;
  for (let i = 0; i < index.length; i += 3) {
    const a = of[index[i]!]!;
    const b = of[index[i + 1]!]!;
    const c = of[index[i + 2]!]!;
    if (a === b || b === c || c === a) continue;
    left[count++] = a;
    left[count++] = b;
    left[count++] = c;
  }
  return left.slice(0, count);
}
