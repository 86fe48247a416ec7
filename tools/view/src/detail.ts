// SPDX-License-Identifier: Apache-2.0
// How much is drawn while the view moves: of many triangles a coarse version, of many lines nothing. At rest all is there.
import { BufferAttribute, BufferGeometry, Group, type LineSegments, type Material, Mesh } from 'three';
import { coarseIndex } from './coarse';
import type { Stage } from './stage';

const MOST = { slow: 40_000, fast: 2_000_000 }; // triangles that are drawn while the view moves
const COARSE = { slow: 25_000, fast: 250_000 }; // what is drawn in their place
const MOST_LINES = { slow: 15_000, fast: 4_000_000 };

const speedOf = (stage: Stage): 'slow' | 'fast' => (stage.isSlow ? 'slow' : 'fast');

/** A surface, drawn coarsely while the view moves where it has many triangles. */
export class DetailedSurface {
  readonly group = new Group();
  readonly full: Mesh;
  private coarse: Mesh | undefined;

  constructor(stage: Stage, geometry: BufferGeometry, material: Material) {
    this.full = new Mesh(geometry, material);
    this.group.add(this.full);
    const speed = speedOf(stage);
    if (this.triangles > MOST[speed]) stage.moving.add((moves) => this.setMoving(moves, COARSE[speed]));
  }

  private setMoving(moves: boolean, wanted: number): void {
    if (!this.group.visible && this.coarse === undefined) return;
    this.coarse ??= this.makeCoarse(wanted);
    this.coarse.visible = moves;
    this.full.visible = !moves;
  }
  private makeCoarse(wanted: number): Mesh {
    const { geometry, material } = this.full;
    const coarse = new BufferGeometry();
    for (const [name, attribute] of Object.entries(geometry.attributes)) coarse.setAttribute(name, attribute);
    const { array: points, count } = geometry.getAttribute('position');
    const index = geometry.getIndex()?.array ?? Uint32Array.from({ length: count }, (_, i) => i);
    coarse.setIndex(new BufferAttribute(coarseIndex(points, index, wanted), 1));
    const mesh = new Mesh(coarse, material);
    this.group.add(mesh);
    return mesh;
  }

  private get triangles(): number {
    const { geometry } = this.full;
    return (geometry.getIndex()?.count ?? geometry.getAttribute('position').count) / 3;
  }
  /** Triangles that are drawn now. */
  get drawn(): number {
    return this.coarse?.visible ? this.coarse.geometry.getIndex()!.count / 3 : this.triangles;
  }
}

/** Lines that are left out while the view moves where they are many. */
export function restingLines(stage: Stage, lines: LineSegments): Group {
  const group = new Group().add(lines);
  const { geometry } = lines;
  const count = (geometry.getIndex()?.count ?? geometry.getAttribute('position').count) / 2;
  if (count > MOST_LINES[speedOf(stage)]) stage.moving.add((moves) => (group.visible = !moves));
  return group;
}
