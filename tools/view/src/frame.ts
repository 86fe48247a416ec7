// SPDX-License-Identifier: Apache-2.0
// Where things are on the stage: the object about the origin, its largest side 1, whatever its unit.
import { Vector3 } from 'three';

export class Frame {
  constructor(
    readonly centre: readonly [number, number, number], // source units
    readonly size: number, // source units
    readonly metresPerUnit: number,
  ) {}

  fromSource(p: ArrayLike<number>): Vector3 {
    return new Vector3((p[0]! - this.centre[0]) / this.size, (p[1]! - this.centre[1]) / this.size, (p[2]! - this.centre[2]) / this.size);
  }
  fromMetres(p: ArrayLike<number>): Vector3 {
    const m = this.metresPerUnit;
    return this.fromSource([p[0]! / m, p[1]! / m, p[2]! / m]);
  }
  toMetres(v: Vector3): [number, number, number] {
    const m = this.metresPerUnit;
    return [
      (v.x * this.size + this.centre[0]) * m,
      (v.y * this.size + this.centre[1]) * m,
      (v.z * this.size + this.centre[2]) * m,
    ];
  }
  /** The object's largest side, metres. */
  get metres(): number {
    return this.size * this.metresPerUnit;
  }
}
