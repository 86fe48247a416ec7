// SPDX-License-Identifier: Apache-2.0
// Colours of what has a number.
import { Color } from 'three';

/** Neighbouring numbers get colours that differ: the hue goes round by the golden section. */
export function colorOfNumber(n: number): [number, number, number] {
  const color = new Color().setHSL((n * 0.618034) % 1, 0.45, 0.62);
  return [color.r, color.g, color.b];
}
