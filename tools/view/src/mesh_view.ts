// SPDX-License-Identifier: Apache-2.0
// A mesh on the stage: its surface, its edges, the findings of each rule as a layer, and what is selected.
import { Box3, BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Raycaster, Sphere, Vector3 } from 'three';
import type { Element3, Issue } from './data';
import { DetailedSurface, restingLines } from './detail';
import { clearGroup, FILLED, type Marks, marked } from './highlight';
import { type MeshModel, newell } from './mesh_model';
import { colorOfNumber } from './number_colors';
import { patchesOf } from './patches';
import type { Stage } from './stage';
import { SurfaceMaterial } from './surface_material';
import { themeColor } from './theme';

const FLAT = 1e-6; // twice the area of a face that cannot be seen, of the object's size squared
const LEAST_RADIUS = 0.004; // of the object's size
const AROUND = 5; // a finding is shown with this many times its own radius about it
const LAYERED = 20000; // elements of a rule that are drawn at once

export interface Picked {
  face: number;
  point: Vector3;
}

export class MeshView {
  readonly group = new Group();
  readonly material = new SurfaceMaterial();
  private readonly surface: DetailedSurface;
  private readonly layers = new Map<string, Group>();
  private readonly selection = new Group();
  private edges: LineSegments | undefined;
  private readonly painted = new Map<'patches' | 'materials', { surface: DetailedSurface; count: number }>();
  private colors: 'patches' | 'materials' | undefined;
  private showsWinding = true;
  /** Of the vertex that is selected. */
  fanCount = 0;

  constructor(
    private readonly stage: Stage,
    readonly model: MeshModel,
  ) {
    this.surface = new DetailedSurface(stage, model.geometry, this.material);
    this.group.add(this.surface.group, this.selection);
  }

  /** Triangles that are drawn now. */
  get drawn(): number {
    return this.surface.drawn;
  }

  applyTheme(): void {
    this.material.applyTheme(this.showsWinding);
    if (this.edges !== undefined) (this.edges.material as LineBasicMaterial).color = themeColor('mesh-edge');
  }

  setWinding(shown: boolean): void {
    this.showsWinding = shown;
    this.applyTheme();
    this.stage.invalidate();
  }

  setEdges(shown: boolean): void {
    if (shown && this.edges === undefined) {
      const pairs = this.model.edges();
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', this.model.geometry.getAttribute('position') as BufferAttribute);
      geometry.setIndex(new BufferAttribute(pairs, 1));
      this.edges = new LineSegments(geometry, new LineBasicMaterial({ color: themeColor('mesh-edge'), transparent: true, opacity: 0.55 }));
      this.group.add(restingLines(this.stage, this.edges));
    }
    if (this.edges !== undefined) this.edges.visible = shown;
    this.stage.invalidate();
  }
  get edgeCount(): number {
    return (this.edges?.geometry.getIndex()?.count ?? 0) / 2;
  }
  get edgesShown(): boolean {
    return this.edges?.visible === true;
  }

  /** Each patch, or each material, in a colour of its own; undefined: all faces alike. */
  setColors(by: 'patches' | 'materials' | undefined): void {
    if (by !== undefined && !this.painted.has(by)) this.painted.set(by, this.paint(by));
    for (const [what, { surface }] of this.painted) surface.group.visible = what === by;
    this.surface.group.visible = by === undefined;
    this.colors = by;
    this.stage.invalidate();
  }
  get colorsShown(): { by: string; count: number } | undefined {
    return this.colors === undefined ? undefined : { by: this.colors, count: this.painted.get(this.colors)!.count };
  }
  private paint(by: 'patches' | 'materials'): { surface: DetailedSurface; count: number } {
    const materials = this.model.faceMaterials;
    const { ofFace, count } = by === 'patches' ? patchesOf(this.model) : { ofFace: materials!, count: new Set(materials).size };
    const geometry = this.model.geometry.toNonIndexed();
    const colors = new Float32Array(9 * this.model.triangleFace.length);
    this.model.triangleFace.forEach((face, t) => {
      const color = colorOfNumber(ofFace[face]!);
      for (let k = 0; k < 3; ++k) colors.set(color, 9 * t + 3 * k);
    });
    geometry.setAttribute('faceColor', new BufferAttribute(colors, 3));
    const surface = new DetailedSurface(this.stage, geometry, new SurfaceMaterial(true));
    this.group.add(surface.group);
    return { surface, count };
  }

  /** What an element of a finding is on the stage. */
  marksOf(element: Element3): Required<Marks> {
    const place = (p: number): Vector3 | undefined => this.model.point(p);
    const lines: Vector3[] = [];
    for (const [a, b] of element.edges ?? []) {
      const ends = [place(a), place(b)];
      if (ends[0] !== undefined && ends[1] !== undefined) lines.push(ends[0], ends[1]);
    }
    const isPlace = (p: Vector3 | undefined): p is Vector3 => p !== undefined;
    const points = (element.vertices ?? []).map(place).filter(isPlace);
    // a vertex that is nowhere: the others of its faces say where it is missed
    if (points.length === 0 && lines.length === 0) for (const p of element.vertices ?? []) points.push(...this.model.neighbours(p).map(place).filter(isPlace));
    if (element.point && (points.length === 0 || (element.faces ?? []).length > 1) && lines.length === 0) points.push(this.model.frame.fromSource(element.point));
    const polygons = (element.faces ?? []).map((f) => this.model.outline(f)).filter((outline) => outline.length >= 3);
    return { polygons, lines, points };
  }

  setLayer(issue: Issue, shown: boolean): void {
    let layer = this.layers.get(issue.rule);
    if (shown && layer === undefined) {
      layer = this.makeLayer(issue);
      this.layers.set(issue.rule, layer);
      this.group.add(layer);
    }
    if (layer !== undefined) layer.visible = shown;
    this.stage.invalidate();
  }
  layerShown(rule: string): boolean {
    return this.layers.get(rule)?.visible === true;
  }

  // Lines where a rule is about edges, points where it is about vertices; else the faces themselves.
  private makeLayer(issue: Issue): Group {
    const all: Required<Marks> = { polygons: [], lines: [], points: [] };
    for (const element of issue.elements.slice(0, LAYERED)) {
      const marks = this.marksOf(element);
      (all.lines as Vector3[]).push(...marks.lines);
      if (marks.lines.length > 0) continue;
      if ((element.vertices ?? []).length > 0 && marks.points.length > 0) (all.points as Vector3[]).push(...marks.points);
      else if (marks.polygons.length > 0) (all.polygons as (readonly Vector3[])[]).push(...marks.polygons);
      else (all.points as Vector3[]).push(...marks.points);
    }
    const color = themeColor(issue.severity);
    const layer = marked({ lines: all.lines, points: all.points }, { color, width: issue.severity === 'error' ? 3 : 2, opacity: 0.9 });
    return layer.add(marked({ polygons: all.polygons }, { color, opacity: 0.5 }));
  }

  select(element: Element3 | undefined, fly = true): void {
    clearGroup(this.selection);
    this.fanCount = 0;
    this.material.setFocus(undefined);
    this.stage.invalidate();
    // faces of a whole rule would hide the one that is looked at
    for (const layer of this.layers.values()) layer.traverse((part) => (part.visible = part.name === FILLED ? element === undefined : part === layer ? layer.visible : true));
    if (element === undefined) return;
    const marks = this.marksOf(element);
    const isOfEdges = marks.lines.length > 0; // then the faces beside them are background
    this.selection.add(marked({ polygons: marks.polygons }, { color: themeColor('glow'), opacity: isOfEdges ? 0.3 : 0.75, onTop: true }));
    this.selection.add(marked({ lines: marks.lines, points: marks.points }, { color: themeColor('glow'), width: 5, onTop: true }));
    const outlines = marks.polygons.flatMap((outline) => outline.flatMap((p, k) => [p, outline[(k + 1) % outline.length]!]));
    // a face without area is seen by its outline alone
    const isFlat = !isOfEdges && marks.polygons.every((outline) => newell(outline).lengthSq() < FLAT ** 2);
    if (outlines.length > 0) this.selection.add(marked({ lines: outlines }, { color: themeColor('glow'), width: isFlat ? 5 : 1.5, onTop: true }));
    this.fanCount = this.showFans(element);
    const ball = this.ballOf(marks);
    if (ball === undefined) return;
    const normal = (element.faces ?? []).reduce((sum, f) => sum.add(this.model.faceNormal(f)), new Vector3());
    this.material.setFocus(ball.center, ball.radius * AROUND);
    if (fly) this.stage.flyTo(ball.center, ball.radius * AROUND, this.clearSide(ball.center, ball.radius, normal));
  }

  /** Where a vertex alone is found: the fans of faces at it in colours of their own, if there are several. Their number. */
  private showFans(element: Element3): number {
    const vertex = element.vertices?.length === 1 && (element.faces ?? []).length === 0 ? element.vertices[0] : undefined;
    const fans = vertex === undefined ? [] : this.model.fans(vertex);
    if (fans.length < 2) return fans.length;
    fans.forEach((faces, k) => {
      const polygons = faces.map((f) => this.model.outline(f)).filter((outline) => outline.length >= 3);
      this.selection.add(marked({ polygons }, { color: new Color(...colorOfNumber(k)), opacity: 0.7, onTop: true }));
    });
    return fans.length;
  }

  /** Of both sides that from which the place is seen: a face that is wound wrongly has its normal inside. */
  private clearSide(centre: Vector3, radius: number, normal: Vector3): Vector3 {
    const far = this.stage.distanceFor(radius * AROUND);
    let best = this.stage.approach(normal);
    let farthest = -1;
    for (const direction of [best, this.stage.approach(normal.clone().negate()), this.stage.approach()]) {
      const ray = new Raycaster(centre, direction, radius * 0.02, far);
      const free = ray.intersectObject(this.surface.full, false)[0]?.distance ?? far;
      if (free > farthest * 1.01) [best, farthest] = [direction, free];
    }
    return best;
  }

  /** The surface about a finding is translucent. */
  get isGhost(): boolean {
    return this.material.isGhost;
  }

  private ballOf(marks: Required<Marks>): Sphere | undefined {
    const box = new Box3();
    for (const p of [...marks.polygons.flat(), ...marks.lines, ...marks.points]) box.expandByPoint(p);
    if (box.isEmpty()) return undefined;
    const ball = box.getBoundingSphere(new Sphere());
    ball.radius = Math.min(Math.max(ball.radius, LEAST_RADIUS), 0.9 / AROUND);
    return ball;
  }

  pick(clientX: number, clientY: number): Picked | undefined {
    const hit = this.stage.rayAt(clientX, clientY).intersectObject(this.surface.full, false)[0];
    if (hit?.faceIndex === undefined || hit.faceIndex === null) return undefined;
    return { face: this.model.triangleFace[hit.faceIndex]!, point: hit.point };
  }
}
