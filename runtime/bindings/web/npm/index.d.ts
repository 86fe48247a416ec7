// SPDX-License-Identifier: Apache-2.0
export interface Params {
  /** static friction, default 0.6 */
  muStatic?: number;
  /** dynamic friction, default 0.4 */
  muDynamic?: number;
  /** newtons a metre, default 1000 */
  stiffness?: number;
  /** newton seconds a metre, default 0 */
  damping?: number;
}

export interface Result {
  /** newtons on the hand */
  force: [number, number, number];
  /** metres, object's frame */
  godObject: [number, number, number];
  state: 'free' | 'face' | 'edge' | 'vertex';
  feature: number;
  isSlipping: boolean;
  flags: number;
}

/** One contact point on one graph, in an instance of the module of its own. */
export class Contact {
  /** Verifies the bytes of a .fdcg file. `wasm`: the module's bytes, where it does not lie beside index.js. */
  static open(bytes: ArrayBuffer | ArrayBufferView, params?: Params, wasm?: BufferSource): Promise<Contact>;
  private constructor();
  setParams(params?: Params): void;
  reset(): void;
  /** A tick: metres in the object's frame. */
  step(x: number, y: number, z: number): Result;
  /** A tick for each three numbers; the forces, three a tick. */
  path(hips: ArrayLike<number>): Float64Array;
}
