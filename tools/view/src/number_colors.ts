// SPDX-License-Identifier: Apache-2.0
// Colours of what has a number.
import { Color } from 'three';

const known = new Map<number, [number, number, number]>();
const MOST_KNOWN = 10_000;

/** Neighbouring numbers get colours that differ: the hue goes round by the golden section. */
export function colorOfNumber(n: number): readonly [number, number, number] {
  const before = known.get(n);
  if (before !== undefined) return before;
  const { r, g, b } = new Color().setHSL((n * 0.618034) % 1, 0.45, 0.62);
  if (known.size < MOST_KNOWN) known.set(n, [r, g, b]);
  return [r, g, b];
}
