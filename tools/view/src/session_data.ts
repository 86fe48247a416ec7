// SPDX-License-Identifier: Apache-2.0
// A session as the page has it (tools/page/session_item.cpp): its scene, and frame by frame where everything is.
import { type ArrayRef, readArray } from './data';

export interface SurfaceSizes {
  kind: 'plane' | 'sphere' | 'cylinder' | 'capsule' | 'box' | 'cone' | 'torus' | 'ellipsoid';
  hollow: boolean;
  radius: number;
  top_radius: number;
  tube_radius: number;
  length: number;
  half: [number, number, number];
}

export interface SessionObject {
  name: string;
  motion: 'fixed' | 'moved' | 'body' | 'soft';
  pose: number[]; // translation, rotation x, y, z, w
  scale: number;
  mu_static: number;
  surface?: SurfaceSizes;
  graph?: number;
}

interface WorldRef {
  ticks_per_frame: number;
  time: ArrayRef;
  devices: { name: string; pads: number[]; numbers: ArrayRef; words: ArrayRef }[];
  moving: number[];
  poses: ArrayRef;
  soft: { object: number; corners: number; time: ArrayRef; moved: ArrayRef }[];
}

export interface SessionRef {
  same: boolean;
  program: string;
  remarks: string[];
  faults: { name: string; text: string }[];
  gravity: [number, number, number];
  ground?: { normal: [number, number, number]; offset: number };
  objects: SessionObject[];
  graphs: (ArrayRef | null)[];
  worlds: WorldRef[];
}

export const PHASES = ['disarmed', 'ramping', 'armed', 'fading'] as const;
const DEVICE_NUMBERS = 7;
const CONTACT_NUMBERS = 12;
const POSE_NUMBERS = 7;

type Triple = [number, number, number];

export interface SessionContact {
  hip: Triple;
  god: Triple;
  force: Triple;
  normal: Triple;
  state: number;
  slips: boolean;
  object: number;
}

/** A device at every frame. */
export class SessionDevice {
  private readonly stride: number;
  constructor(
    readonly name: string,
    readonly pads: readonly number[],
    private readonly numbers: Float32Array,
    private readonly words: Uint32Array,
  ) {
    this.stride = DEVICE_NUMBERS + CONTACT_NUMBERS * pads.length;
  }
  private triple(at: number): Triple {
    return [this.numbers[at]!, this.numbers[at + 1]!, this.numbers[at + 2]!];
  }
  private word(i: number): number {
    return this.words[i * (1 + this.pads.length)]!;
  }
  wanted(i: number): Triple {
    return this.triple(i * this.stride);
  }
  sent(i: number): Triple {
    return this.triple(i * this.stride + 3);
  }
  /** The largest force of the frame's ticks, newtons. */
  peak(i: number): number {
    return this.numbers[i * this.stride + 6]!;
  }
  state(i: number): number {
    return this.word(i) & 3;
  }
  slips(i: number): boolean {
    return (this.word(i) & 4) !== 0;
  }
  phase(i: number): number {
    return (this.word(i) >>> 3) & 3;
  }
  fault(i: number): number {
    return this.word(i) >>> 5;
  }
  contact(i: number, k: number): SessionContact {
    const at = i * this.stride + DEVICE_NUMBERS + CONTACT_NUMBERS * k;
    const word = this.words[i * (1 + this.pads.length) + 1 + k]!;
    return { hip: this.triple(at), god: this.triple(at + 3), force: this.triple(at + 6), normal: this.triple(at + 9), state: word & 3, slips: (word & 4) !== 0, object: word >>> 3 };
  }
}

/** The corners of a soft object, from their places, at some times. */
export class SoftSamples {
  constructor(
    readonly object: number,
    private readonly corners: number,
    private readonly time: Float64Array,
    private readonly moved: Float32Array,
  ) {}
  /** Three numbers a corner, metres in the object's frame: those of the last sample up to t. */
  at(t: number): Float32Array {
    const i = Math.max(0, lastUpTo(this.time, t));
    return this.moved.subarray(3 * this.corners * i, 3 * this.corners * (i + 1));
  }
}

/** The last place whose time is at most t; -1: none. */
export function lastUpTo(time: Float64Array, t: number): number {
  let low = -1;
  let high = time.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (time[middle]! <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Devices that feel one scene. */
export class SessionWorld {
  private constructor(
    readonly ticksPerFrame: number,
    readonly time: Float64Array,
    readonly devices: readonly SessionDevice[],
    readonly moving: readonly number[],
    private readonly poses: Float32Array,
    readonly soft: readonly SoftSamples[],
  ) {}

  static async read(from: WorldRef): Promise<SessionWorld> {
    const floats = async (ref: ArrayRef): Promise<Float32Array> => new Float32Array((await readArray(ref)).buffer);
    const doubles = async (ref: ArrayRef): Promise<Float64Array> => new Float64Array((await readArray(ref)).buffer);
    const devices: SessionDevice[] = [];
    for (const device of from.devices) devices.push(new SessionDevice(device.name, device.pads, await floats(device.numbers), new Uint32Array((await readArray(device.words)).buffer)));
    const soft: SoftSamples[] = [];
    for (const one of from.soft) soft.push(new SoftSamples(one.object, one.corners, await doubles(one.time), await floats(one.moved)));
    return new SessionWorld(from.ticks_per_frame, await doubles(from.time), devices, from.moving, await floats(from.poses), soft);
  }

  get frames(): number {
    return this.time.length;
  }
  /** Of the k-th of the moving objects: translation, rotation x, y, z, w. */
  pose(i: number, k: number): Float32Array {
    const at = POSE_NUMBERS * (i * this.moving.length + k);
    return this.poses.subarray(at, at + POSE_NUMBERS);
  }
}
