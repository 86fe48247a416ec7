// SPDX-License-Identifier: Apache-2.0
// Edges of many faces, each found once: in lists by one of its points, that with fewer sides at it, so that no list is long.

export interface Faces {
  readonly corners: Uint32Array;
  readonly faceStart: Uint32Array;
  readonly pointCount: number;
}

/** Of each side of a face, in the order of the file: `edge` numbers the pairs of points, from 0 to less than the corners' number. */
export type SideVisitor = (edge: number, isNew: boolean, face: number, a: number, b: number) => void;

/** `same`: of each point that which stands for it. Sides with an end nowhere, or both ends alike, are left out. */
export function eachSide({ corners, faceStart, pointCount }: Faces, same: Uint32Array | undefined, visit: SideVisitor): void {
  const point = (corner: number): number => (same === undefined ? corners[corner]! : same[corners[corner]!] ?? pointCount);
  const sides = new Uint32Array(pointCount); // at each point
  const walk = (each: (face: number, a: number, b: number) => void): void => {
    for (let f = 0; f + 1 < faceStart.length; ++f) {
      const first = faceStart[f]!;
      const end = faceStart[f + 1]!;
      for (let k = first; k < end; ++k) {
        const a = point(k);
        const b = point(k + 1 === end ? first : k + 1);
        if (a < pointCount && b < pointCount && a !== b) each(f, a, b);
      }
    }
  };
  walk((_, a, b) => {
    ++sides[a]!;
    ++sides[b]!;
  });
  const isFirst = (a: number, b: number): boolean => sides[a]! < sides[b]! || (sides[a] === sides[b] && a < b);
  const starts = new Uint32Array(pointCount + 1);
  walk((_, a, b) => ++starts[(isFirst(a, b) ? a : b) + 1]!);
  for (let p = 0; p < pointCount; ++p) starts[p + 1]! += starts[p]!;
  const ends = starts.slice(0, pointCount);
  const others = new Uint32Array(starts[pointCount]!);
  walk((f, a, b) => {
    const [owner, other] = isFirst(a, b) ? [a, b] : [b, a];
    const end = ends[owner]!;
    let at = starts[owner]!;
    while (at < end && others[at] !== other) ++at;
    if (at === end) {
      others[at] = other;
      ends[owner] = end + 1;
    }
    visit(at, at === end, f, a, b);
  });
}
