// SPDX-License-Identifier: Apache-2.0
// The runtime in the page: one instance of the module, with one graph, one contact, a relief and effects
// (runtime/bindings/web/fdcg_web.c).
import { shortest } from './numbers';

interface Exports {
  memory: WebAssembly.Memory;
  fdcg_web_allocate(bytes: number): number;
  fdcg_web_release(room: number): void;
  fdcg_web_open(data: number, bytes: number): number;
  fdcg_web_message(): number;
  fdcg_web_source_map(): number;
  fdcg_web_visual(): number;
  fdcg_web_hip(): number;
  fdcg_web_result(): number;
  fdcg_web_set_material(material: number, muStatic: number, muDynamic: number, stiffness: number): void;
  fdcg_web_set_params(muStatic: number, muDynamic: number, stiffness: number, damping: number, flags: number, stribeck: number, viscous: number, presliding: number, lag: number): number;
  fdcg_web_has_normals(): number;
  fdcg_web_has_heights(): number;
  fdcg_web_set_relief(kind: number, a: number, b: number, c: number): void;
  fdcg_web_set_effect(kind: number, isOn: number, a: number, b: number, c: number): void;
  fdcg_web_reset(): void;
  fdcg_web_step(): void;
  fdcg_web_run(hips: number, results: number, count: number): void;
  fdcg_web_cast(fx: number, fy: number, fz: number, tx: number, ty: number, tz: number): number;
  fdcg_web_node(node: number): number;
  fdcg_web_side(node: number, side: number): number;
  fdcg_web_node_normals(node: number): number;
  fdcg_web_connection(connection: number): number;
  fdcg_web_corner(corner: number): number;
  fdcg_web_fan(corner: number): number;
  fdcg_web_material_count(): number;
  fdcg_web_material_name(material: number): number;
  fdcg_web_node_material(node: number): number;
}

export const NONE = 0xffffffff;
export const STATES = ['free', 'face', 'edge', 'vertex'] as const;
export const TYPES = ['convex', 'concave', 'coplanar', 'boundary'] as const;
const FLATNESS = ['exact', 'quantum', 'angle'] as const;

/** fdcg_friction_flag. */
export const FRICTION = { stribeck: 1, viscous: 2, presliding: 4, lag: 8 } as const;
const FRICTION_MATERIALS = 16;
const FRICTION_SHADING = 64;
/** By the number that fdcg_web_set_relief has for them; 0 is none. */
const RELIEFS = ['none', 'ridges', 'bumps', 'grain', 'image'] as const;
/** By fdcg_effect_kind, from 1 on: what each maker takes, by the keys that scenes and fdcg-servo have for it. */
export const EFFECTS = {
  magnet: ['force_n', 'distance_m'],
  viscosity: ['viscosity_n_s_per_m'],
  'stick-slip': ['stiffness_n_per_m', 'force_n'],
  vibration: ['force_n', 'frequency_hz'],
  noise: ['force_n', 'low_hz', 'high_hz'],
  tap: ['impact_n_s_per_m', 'frequency_hz', 'decay_s'],
  pulse: ['force_n', 'duration_s', 'period_s'],
} as const;
export type EffectKind = keyof typeof EFFECTS;

/** Heights that are felt; the numbers, metres, are those of fdcg-servo replay --relief. */
export interface Relief {
  kind: (typeof RELIEFS)[number];
  numbers: number[];
}
export type CurveTerm = keyof typeof FRICTION;

export interface Material {
  muStatic: number;
  muDynamic: number;
  stiffness: number;
}

export interface TouchParams extends Material {
  damping: number;
  /** What is there is on. */
  curve: Partial<Record<CurveTerm, number>>;
  /** By number; undefined: all faces feel alike. */
  materials?: Material[];
  /** Does nothing where the graph has no normals. */
  shading: boolean;
  relief: Relief;
  /** What is there is on. */
  effects: Partial<Record<EffectKind, number[]>>;
}

export interface Result {
  force: [number, number, number];
  godObject: [number, number, number];
  state: number;
  feature: number;
  slipping: number;
  transitions: number;
}

export interface GraphHeader {
  real: number;
  nodes: number;
  connections: number;
  corners: number;
  largestFan: number;
  origin: [number, number, number];
  metresPerUnit: number;
  low: [number, number, number];
  high: [number, number, number];
  extent: number;
  types: [number, number, number, number];
  sourceFaces: number;
}

const TIMED_PASSES = 25;
const TIMED_GRAINS = 20; // a pass is at least so many steps of the clock, which differ between browsers

/** The smallest step of the clock, milliseconds. */
function clockGrain(): number {
  let grain = Infinity;
  for (let k = 0; k < 3; ++k) {
    const before = performance.now();
    let now = before;
    while (now === before) now = performance.now();
    grain = Math.min(grain, now - before);
  }
  return grain;
}

type Triple = [number, number, number];

export class Runtime {
  private readonly x: Exports;
  private base = 0;
  private size = 0;
  constructor(instance: WebAssembly.Instance) {
    this.x = instance.exports as unknown as Exports;
  }
  static async make(wasm: Uint8Array<ArrayBuffer>): Promise<Runtime> {
    return new Runtime((await WebAssembly.instantiate(wasm)).instance);
  }

  private view(at: number): DataView {
    return new DataView(this.x.memory.buffer, at);
  }
  private triple(view: DataView, at: number): Triple {
    return [view.getFloat64(at, true), view.getFloat64(at + 8, true), view.getFloat64(at + 16, true)];
  }
  private text(at: number): string {
    const bytes = new Uint8Array(this.x.memory.buffer, at);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /** Throws with the runtime's own message where it refuses the file. */
  open(file: Uint8Array): void {
    this.base = this.x.fdcg_web_allocate(file.length);
    if (this.base === 0) throw new Error('there is not enough memory for the graph');
    this.size = file.length;
    new Uint8Array(this.x.memory.buffer, this.base, file.length).set(file);
    if (this.x.fdcg_web_open(this.base, file.length) !== 0) throw new Error(this.text(this.x.fdcg_web_message()));
  }
  /** The open file's bytes, where they lie; until memory grows. */
  bytes(): Uint8Array {
    return new Uint8Array(this.x.memory.buffer, this.base, this.size);
  }
  /** fdcg_visual, checked, where it lies in memory; until memory grows. Undefined: the file has none. */
  visual(): { vertices: DataView; indices: Uint32Array; materials: DataView } | undefined {
    const at = this.x.fdcg_web_visual();
    if (at === 0) return undefined;
    const v = this.view(at);
    const word = (k: number): number => v.getUint32(4 * k, true);
    const { buffer } = this.x.memory;
    return {
      vertices: new DataView(buffer, word(0), 40 * word(4)),
      indices: new Uint32Array(buffer, word(1), word(5)),
      materials: new DataView(buffer, word(3), 96 * word(6)),
    };
  }
  header(): GraphHeader {
    const v = this.view(this.base);
    const word = (at: number): number => v.getUint32(at, true);
    return {
      real: word(24),
      nodes: word(32),
      connections: word(40),
      corners: word(44),
      largestFan: word(52),
      origin: this.triple(v, 56),
      metresPerUnit: v.getFloat64(80, true),
      low: this.triple(v, 88),
      high: this.triple(v, 112),
      extent: v.getFloat64(136, true),
      types: [word(160), word(164), word(168), word(172)],
      sourceFaces: word(180),
    };
  }

  /** Empty, or what the runtime has against them: then the old ones stay. */
  setParams(p: TouchParams): string {
    let flags = (p.materials === undefined ? 0 : FRICTION_MATERIALS) | (p.shading ? FRICTION_SHADING : 0);
    for (const term of Object.keys(p.curve) as CurveTerm[]) flags |= FRICTION[term];
    p.materials?.forEach((m, i) => this.x.fdcg_web_set_material(i, m.muStatic, m.muDynamic, m.stiffness));
    const [a = 0, b = 0, c = 0] = p.relief.numbers;
    this.x.fdcg_web_set_relief(RELIEFS.indexOf(p.relief.kind), a, b, c);
    for (const [i, kind] of (Object.keys(EFFECTS) as EffectKind[]).entries()) {
      const numbers = p.effects[kind];
      this.x.fdcg_web_set_effect(i + 1, Number(numbers !== undefined), numbers?.[0] ?? 0, numbers?.[1] ?? 0, numbers?.[2] ?? 0);
    }
    const { stribeck = 0, viscous = 0, presliding = 0, lag = 0 } = p.curve;
    const status = this.x.fdcg_web_set_params(p.muStatic, p.muDynamic, p.stiffness, p.damping, flags, stribeck, viscous, presliding, lag);
    return status === 0 ? '' : this.text(this.x.fdcg_web_message());
  }
  get hasNormals(): boolean {
    return this.x.fdcg_web_has_normals() !== 0;
  }
  get hasHeights(): boolean {
    return this.x.fdcg_web_has_heights() !== 0;
  }
  materials(): string[] {
    return Array.from({ length: this.x.fdcg_web_material_count() }, (_, i) => this.text(this.x.fdcg_web_material_name(i)));
  }
  reset(): void {
    this.x.fdcg_web_reset();
  }
  step(hip: ArrayLike<number>): Result {
    new Float64Array(this.x.memory.buffer, this.x.fdcg_web_hip(), 3).set([hip[0]!, hip[1]!, hip[2]!]);
    this.x.fdcg_web_step();
    return this.resultAt(this.x.fdcg_web_result());
  }
  private resultAt(at: number): Result {
    const v = this.view(at);
    return {
      force: this.triple(v, 0),
      godObject: this.triple(v, 24),
      state: v.getUint32(48, true),
      feature: v.getUint32(52, true),
      slipping: v.getUint32(56, true),
      transitions: v.getUint32(60, true),
    };
  }
  /** Nanoseconds a step, over this path, by a contact that begins anew: the fastest of some passes, since the first ones run while
   * the browser still compiles, and others may be held up. */
  timeSteps(hips: Float64Array, params: TouchParams): number {
    this.setParams(params);
    const count = hips.length / 3;
    const input = this.x.fdcg_web_allocate(hips.byteLength);
    const output = this.x.fdcg_web_allocate(72 * count);
    let best = Number.NaN;
    const least = TIMED_GRAINS * clockGrain();
    if (input !== 0 && output !== 0) {
      new Float64Array(this.x.memory.buffer, input, hips.length).set(hips);
      for (let pass = 0; pass < TIMED_PASSES; ++pass) {
        const before = performance.now();
        let elapsed = 0;
        let steps = 0;
        do {
          this.reset();
          this.x.fdcg_web_run(input, output, count);
          steps += count;
          elapsed = performance.now() - before;
        } while (elapsed < least);
        const spent = (elapsed * 1e6) / steps;
        if (!(spent >= best)) best = spent;
      }
    }
    this.x.fdcg_web_release(input);
    this.x.fdcg_web_release(output);
    return best;
  }
  /** Where the way from a to b (metres) meets the surface first. */
  cast(a: Triple, b: Triple): Result | undefined {
    const met = this.resultAt(this.x.fdcg_web_cast(a[0], a[1], a[2], b[0], b[1], b[2]));
    return met.state === 0 ? undefined : met;
  }

  node(node: number): { normal: Triple; offset: number; sides: number; inexact: boolean } {
    const v = this.view(this.x.fdcg_web_node(node));
    return { normal: this.triple(v, 0), offset: v.getFloat64(24, true), sides: v.getUint32(32, true), inexact: (v.getUint32(36, true) & 1) !== 0 };
  }
  /** The normal that shading interpolates over a node, at a place on it (metres). */
  shadedNormal(node: number, place: readonly [number, number, number]): Triple {
    const v = this.view(this.x.fdcg_web_node_normals(node));
    const normals = [0, 24, 48].map((at) => this.triple(v, at));
    const { origin, metresPerUnit } = this.header();
    const local = place.map((x, k) => x / metresPerUnit - origin[k]!);
    const arms = [0, 1, 2].map((side) => this.corner(this.side(node, side).corner).point.map((x, k) => x - local[k]!));
    const face = this.node(node).normal;
    const weights = [0, 1, 2].map((k) => volume(arms[(k + 1) % 3]!, arms[(k + 2) % 3]!, face));
    const sum = [0, 1, 2].map((k) => normals.reduce((total, normal, i) => total + weights[i]! * normal[k]!, 0));
    const length = Math.hypot(...sum);
    return [sum[0]! / length, sum[1]! / length, sum[2]! / length];
  }
  side(node: number, side: number): { normal: Triple; offset: number; connection: number; corner: number; across: number } {
    const v = this.view(this.x.fdcg_web_side(node, side));
    return { normal: this.triple(v, 0), offset: v.getFloat64(24, true), connection: v.getUint32(32, true), corner: v.getUint32(40, true), across: v.getUint32(44, true) };
  }
  connection(connection: number): { direction: Triple; length: number; corners: [number, number]; nodes: [number, number]; type: number; flatness: number } {
    const v = this.view(this.x.fdcg_web_connection(connection));
    return {
      direction: this.triple(v, 0),
      length: v.getFloat64(24, true),
      corners: [v.getUint32(32, true), v.getUint32(36, true)],
      nodes: [v.getUint32(40, true), v.getUint32(44, true)],
      type: v.getUint32(56, true),
      flatness: v.getUint32(60, true),
    };
  }
  corner(corner: number): { point: Triple; normal: Triple; fan: number; open: boolean } {
    const v = this.view(this.x.fdcg_web_corner(corner));
    return { point: this.triple(v, 0), normal: this.triple(v, 24), fan: v.getUint32(48, true), open: v.getUint32(52, true) !== 0 };
  }
  fan(corner: number): number[] {
    const count = Math.min(this.corner(corner).fan, 4096);
    return [...new Uint32Array(this.x.memory.buffer, this.x.fdcg_web_fan(corner), count)].map((entry) => entry >>> 1);
  }
  material(node: number): string | undefined {
    const at = this.x.fdcg_web_node_material(node);
    return at === 0 ? undefined : this.text(at);
  }
  /** Of each source face its node, or NONE; undefined where the file does not have it. */
  sourceMap(): Uint32Array | undefined {
    const at = this.x.fdcg_web_source_map();
    return at === 0 ? undefined : new Uint32Array(this.x.memory.buffer, at, this.header().sourceFaces).slice();
  }

  // ---- records as fdcg inspect --dump prints them

  dumpNode(n: number): string[] {
    const node = this.node(n);
    const lines = [`node ${n}: normal ${vector(node.normal)} offset ${shortest(node.offset)}, ${node.sides} sides${node.inexact ? ', inexact' : ''}`];
    for (let k = 0; k < node.sides; ++k) {
      const side = this.side(n, k);
      const across = side.across === NONE ? 'none' : String(side.across);
      lines.push(
        `  side ${k}: connection ${side.connection} from corner ${side.corner} to node ${across}, Voronoi plane ${vector(side.normal)} ${shortest(side.offset)}`,
      );
    }
    return lines;
  }
  dumpConnection(c: number): string[] {
    const edge = this.connection(c);
    const second = edge.nodes[1] === NONE ? 'none' : String(edge.nodes[1]);
    return [
      `connection ${c}: ${TYPES[edge.type]} (${FLATNESS[edge.flatness]}), corners ${edge.corners[0]} ${edge.corners[1]}, nodes ${edge.nodes[0]} ${second}, ` +
        `edge ${vector(edge.direction)} length ${shortest(edge.length)}`,
    ];
  }
  dumpCorner(v: number): string[] {
    const corner = this.corner(v);
    const fan = this.fan(v).map((entry) => ` ${entry}`);
    return [
      `corner ${v}: ${vector(corner.point)}, normal ${vector(corner.normal)}${corner.open ? ', open' : ''}, fan${corner.fan > 32 ? ' with a tree:' : ''}${fan.join('')}`,
    ];
  }
}

/** (a x b) . c */
function volume(a: readonly number[], b: readonly number[], c: readonly number[]): number {
  return (a[1]! * b[2]! - a[2]! * b[1]!) * c[0]! + (a[2]! * b[0]! - a[0]! * b[2]!) * c[1]! + (a[0]! * b[1]! - a[1]! * b[0]!) * c[2]!;
}

function vector(v: Triple): string {
  return `(${v.map(shortest).join(' ')})`;
}
