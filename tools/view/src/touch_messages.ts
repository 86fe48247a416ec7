// SPDX-License-Identifier: Apache-2.0
// What the page and the Worker that steps say to each other.
import type { TouchParams } from './runtime';

/** Numbers of one tick: t, HIP, god-object, force, state, feature, slip, transitions. Seconds, metres, newtons. */
export const TICK = 14;
export const T = 0;
export const HIP = 1;
export const GOD = 4;
export const FORCE = 7;
export const STATE = 10;
export const FEATURE = 11;
export const SLIP = 12;
export const TRANSITIONS = 13;
export const TICK_S = 0.001;

export type ToWorker =
  | { kind: 'open'; wasm: Uint8Array<ArrayBuffer>; graph: Uint8Array<ArrayBuffer>; params: TouchParams }
  | { kind: 'run'; on: boolean }
  | { kind: 'target'; hip: [number, number, number]; jump: boolean }
  | { kind: 'params'; params: TouchParams }
  | { kind: 'hand'; metresPerS: number } // its largest speed; 0: none
  | { kind: 'record'; on: boolean };

export type FromWorker =
  | { kind: 'opened' }
  | { kind: 'failed'; message: string }
  | { kind: 'ticks'; ticks: Float64Array; normals: Float64Array; timing: Timing }
  | { kind: 'recording'; seconds: number }
  | { kind: 'recorded'; ticks: Float64Array };

export interface Timing {
  stepNs: number; // mean of the last ticks, with the call from JavaScript
  periodP99Ms: number; // of the time between ticks, over the last seconds
}
