// SPDX-License-Identifier: Apache-2.0
// A graph: nodes, edges by type, corners with busy fans, the hierarchy's boxes, and the records of what is picked.
import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Vector3 } from 'three';
import type { Context, Tab } from './context';
import { DetailedSurface, restingLines } from './detail';
import { checkbox, h, replaceChildren } from './dom';
import type { BoxLevel, GraphModel } from './graph_model';
import { clearGroup, dots, fatLines, filled, marked } from './highlight';
import { colorOfNumber } from './number_colors';
import { grouped } from './numbers';
import { TYPES } from './runtime';
import { SurfaceMaterial } from './surface_material';
import { themeColor } from './theme';
import { visualOf } from './visual_model';

export type Feature = { kind: 'node' | 'connection' | 'corner'; number: number };
const KINDS = ['node', 'connection', 'corner'] as const;

export class GraphTab implements Tab {
  readonly id = 'graph';
  readonly title = 'Graph';
  readonly element = h('div.tab');
  private readonly group = new Group();
  private readonly details = new Group(); // what only this tab shows
  private readonly selection = new Group();
  private readonly material = new SurfaceMaterial(true);
  private readonly surface: DetailedSurface;
  private readonly edges: LineSegments[];
  private readonly hasSeen: boolean; // the mesh for the eye
  private seen: DetailedSurface | undefined;
  private seenMaterials: string[] = [];
  private readonly records = h('pre.records', { tabIndex: 0, 'aria-label': 'Records of what is picked' });
  private readonly boxes = new Group();
  private levels: BoxLevel[] | undefined;
  private picked: Feature | undefined;
  private colours = 'plain';
  private planes = 0; // Voronoi planes of a node, end planes of an edge that are drawn

  constructor(
    private readonly context: Context,
    private readonly model: GraphModel,
    private readonly showMesh: (shown: boolean) => void,
  ) {
    this.surface = new DetailedSurface(context.stage, model.geometry, this.material);
    this.hasSeen = model.runtime.visual() !== undefined;
    this.edges = TYPES.map((_, type) => {
      const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(model.lines[type]!, 3));
      return new LineSegments(geometry, new LineBasicMaterial());
    });
    const busy = dots(model.busyCorners, { color: themeColor('glow'), width: 2.5 });
    busy.name = 'busy';
    this.details.add(...this.edges.map((lines) => restingLines(context.stage, lines)), busy, this.boxes, this.selection);
    this.group.add(this.surface.group, this.details);
    this.group.visible = false;
    context.stage.content.add(this.group);
    this.element.append(this.counts(), this.looks(), this.finder(), this.records);
    this.colour(this.hasSeen ? 'seen' : 'plain');
    this.applyTheme();
    this.showRecords();
  }

  private counts(): HTMLElement {
    const header = this.model.runtime.header();
    return h('p.counts', {}, `${grouped(header.nodes)} nodes, ${grouped(header.connections)} edges, ${grouped(header.corners)} corners, ${header.real === 8 ? 'f64' : 'f32'}.`);
  }

  private looks(): HTMLElement {
    const header = this.model.runtime.header();
    const types = TYPES.map((type, k) =>
      h('div.legend', {}, checkbox(`${type} (${grouped(header.types[k]!)})`, type !== 'coplanar' || header.types[k]! > 0, (shown) => this.showEdges(k, shown), `edges-${type}`), h(`span.swatch.${type}`, { 'aria-hidden': 'true' })),
    );
    const select = h('select', { id: 'node-colour', onchange: () => this.colour(select.value) });
    for (const [value, text] of [['plain', 'one colour'], ['number', 'by node: merged regions'], ['sides', 'by number of sides'], ['material', 'by material'], ...(this.hasSeen ? ([['seen', 'as they are seen']] as const) : [])] as const) select.append(h('option', { value }, text));
    select.value = this.hasSeen ? 'seen' : 'plain';
    const level = h('select', { id: 'box-level', onchange: () => this.showBoxes(Number(select2().value)) });
    const select2 = (): HTMLSelectElement => level;
    level.append(h('option', { value: '-1' }, 'none'));
    for (let items = Math.ceil(header.nodes / 4), n = 0; ; items = Math.ceil(items / 8)) {
      level.append(h('option', { value: String(n++) }, n === 1 ? 'root' : `level ${n}`));
      if (Math.ceil(items / 8) === 1) break;
    }
    return h(
      'section.looks',
      {},
      h('fieldset', {}, h('legend', {}, 'Edges'), ...types, checkbox(`busy corners (${grouped(this.model.busyCorners.length)})`, true, (shown) => this.show('busy', shown), 'show-busy')),
      h('label.field', { for: 'node-colour' }, 'Nodes'),
      select,
      h('label.field', { for: 'box-level' }, 'Hierarchy boxes'),
      level,
    );
  }

  private finder(): HTMLElement {
    const kind = h('select', { id: 'record-kind', 'aria-label': 'Kind of record' });
    for (const name of KINDS) kind.append(h('option', { value: name }, name));
    const number = h('input', { type: 'number', id: 'record-number', min: '0', step: '1', value: '0', 'aria-label': 'Number of the record' });
    const form = h('form.row', {
      onsubmit: ((event: Event) => {
        event.preventDefault();
        this.pickFeature({ kind: kind.value as Feature['kind'], number: Number(number.value) }, true);
      }) as (event: never) => void,
    }, kind, number, h('button', { type: 'submit', id: 'record-show' }, 'Show'));
    return h('section', {}, h('h2', {}, 'Records'), form);
  }

  private show(name: string, shown: boolean): void {
    const object = this.group.getObjectByName(name);
    if (object !== undefined) object.visible = shown;
    this.context.stage.invalidate();
  }
  private showEdges(type: number, shown: boolean): void {
    this.edges[type]!.visible = shown;
    this.context.stage.invalidate();
  }

  private colour(by: string): void {
    this.colours = by;
    this.showSeen(by === 'seen');
    const plain = themeColor('face-front');
    const { runtime } = this.model;
    const names = new Map<string, number>();
    this.model.paint((n) => {
      if (by === 'number') return colorOfNumber(n);
      if (by === 'sides') return colorOfNumber(runtime.node(n).sides * 2 - 5);
      if (by === 'material') {
        const name = runtime.material(n);
        if (name === undefined) return [plain.r, plain.g, plain.b];
        if (!names.has(name)) names.set(name, names.size);
        return colorOfNumber(names.get(name)!);
      }
      return [plain.r, plain.g, plain.b];
    });
    this.context.stage.invalidate();
  }

  private showSeen(shown: boolean): void {
    const visual = shown && this.seen === undefined ? visualOf(this.model) : undefined;
    if (visual !== undefined) {
      this.seen = new DetailedSurface(this.context.stage, visual.geometry, new SurfaceMaterial(true, true));
      this.seenMaterials = visual.materials;
      this.group.add(this.seen.group);
    }
    if (this.seen !== undefined) this.seen.group.visible = shown;
    this.surface.group.visible = !shown || this.seen === undefined;
  }

  private showBoxes(level: number): void {
    clearGroup(this.boxes);
    this.levels ??= this.model.boxes();
    const found = this.levels[level];
    if (found !== undefined) {
      const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(found.lines, 3));
      this.boxes.add(new LineSegments(geometry, new LineBasicMaterial({ color: themeColor('note') })));
    }
    this.context.stage.invalidate();
  }

  // ---- records

  private exists(feature: Feature): boolean {
    const header = this.model.runtime.header();
    const count = { node: header.nodes, connection: header.connections, corner: header.corners }[feature.kind];
    return Number.isInteger(feature.number) && feature.number >= 0 && feature.number < count;
  }

  pickFeature(feature: Feature | undefined, fly: boolean): void {
    clearGroup(this.selection);
    this.planes = 0;
    this.material.setFocus(undefined);
    this.picked = feature !== undefined && this.exists(feature) ? feature : undefined;
    if (feature !== undefined && this.picked === undefined) this.records.textContent = `There is no ${feature.kind} ${feature.number}.`;
    else this.showRecords();
    if (this.picked !== undefined) {
      const places = { node: () => this.markNode(this.picked!.number), connection: () => this.markConnection(this.picked!.number), corner: () => this.markCorner(this.picked!.number) }[this.picked.kind]();
      const centre = places.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(places.length);
      const radius = Math.max(0.002, ...places.map((p) => p.distanceTo(centre)));
      if (fly) this.context.stage.flyTo(centre, Math.min(0.9, radius * 5), this.context.stage.approach(this.normalOf(this.picked)));
      this.context.hint('');
      this.context.announce(`${this.picked.kind} ${this.picked.number}`);
    }
    this.context.stage.invalidate();
  }

  private normalOf(feature: Feature): Vector3 {
    const { runtime } = this.model;
    const node = feature.kind === 'node' ? feature.number : feature.kind === 'connection' ? runtime.connection(feature.number).nodes[0] : undefined;
    return new Vector3(...(node === undefined ? runtime.corner(feature.number).normal : runtime.node(node).normal));
  }

  private showRecords(): void {
    const { runtime } = this.model;
    if (this.picked === undefined) {
      replaceChildren(this.records, 'Click a face, an edge or a corner.');
      return;
    }
    const { kind, number } = this.picked;
    const lines = kind === 'node' ? runtime.dumpNode(number) : kind === 'connection' ? runtime.dumpConnection(number) : runtime.dumpCorner(number);
    const material = kind === 'node' ? runtime.material(number) : undefined;
    this.records.textContent = lines.join('\n') + (material === undefined ? '' : `\n  material: ${material}`);
  }

  /** A node, and the Voronoi plane through each of its sides as a strip that stands on it. */
  private markNode(n: number): Vector3[] {
    const outline = this.model.outline(n);
    const normal = new Vector3(...this.model.runtime.node(n).normal);
    const height = Math.max(...outline.map((p) => p.distanceTo(outline[0]!))) * 0.35;
    const strips = outline.map((p, k) => {
      const q = outline[(k + 1) % outline.length]!;
      return [p, q, q.clone().addScaledVector(normal, height), p.clone().addScaledVector(normal, height)];
    });
    this.selection.add(marked({ polygons: [outline] }, { color: themeColor('glow'), opacity: 0.8 }));
    this.planes = strips.length;
    this.selection.add(filled(strips, { color: themeColor('note'), opacity: 0.28 }));
    this.selection.add(fatLines(strips.flatMap((s) => [s[0]!, s[1]!, s[1]!, s[2]!, s[2]!, s[3]!]), { color: themeColor('note'), width: 1.5 }));
    return outline;
  }

  /** An edge, its nodes, and the end planes at its corners. */
  private markConnection(c: number): Vector3[] {
    const edge = this.model.runtime.connection(c);
    const ends = edge.corners.map((v) => this.model.corner(v));
    const direction = new Vector3(...edge.direction);
    const normal = new Vector3(...this.model.runtime.node(edge.nodes[0]).normal);
    const across = direction.clone().cross(normal).normalize();
    const size = ends[0]!.distanceTo(ends[1]!) * 0.3;
    const planes = ends.map((p) => [[-1, -0.5], [1, -0.5], [1, 1.5], [-1, 1.5]].map(([a, b]) => p.clone().addScaledVector(across, a! * size).addScaledVector(normal, b! * size)));
    this.planes = planes.length;
    const nodes = edge.nodes.filter((n) => n < this.model.runtime.header().nodes).map((n) => this.model.outline(n));
    this.selection.add(filled(nodes, { color: themeColor('glow'), opacity: 0.25 }), filled(planes, { color: themeColor('note'), opacity: 0.3 }));
    this.selection.add(fatLines(ends, { color: themeColor('glow'), width: 5, onTop: true }));
    return ends;
  }

  private markCorner(v: number): Vector3[] {
    const place = this.model.corner(v);
    const spokes = this.model.runtime.fan(v).map((c) => this.model.runtime.connection(c).corners.map((end) => this.model.corner(end)));
    this.selection.add(fatLines(spokes.flat(), { color: themeColor('glow'), width: 3 }), dots([place], { color: themeColor('glow'), width: 4, onTop: true }));
    return spokes.flat();
  }

  pointer(event: PointerEvent): void {
    const hit = this.context.stage.rayAt(event.clientX, event.clientY).intersectObject(this.surface.full, false)[0];
    if (hit?.faceIndex === undefined || hit.faceIndex === null) {
      this.pickFeature(undefined, false);
      return;
    }
    const pixels = 7;
    const perPixel = (2 * Math.tan((this.context.stage.camera.fov * Math.PI) / 360) * hit.distance) / this.context.stage.canvas.clientHeight;
    this.pickFeature(this.model.featureAt(this.model.triangleNode[hit.faceIndex]!, hit.point, pixels * perPixel), false);
  }

  /** Where there is no mesh the nodes alone are its surface, also for the other tabs. */
  set showSurface(shown: boolean) {
    this.isSurface = shown;
    this.setInUse(false);
  }
  private isSurface = false;
  private setInUse(inUse: boolean): void {
    this.group.visible = inUse || this.isSurface;
    this.details.visible = inUse;
    if (!inUse) this.material.setFocus(undefined);
  }

  activate(): void {
    this.setInUse(true);
    this.showMesh(false);
    this.context.hint('Click a face, an edge or a corner to see its record.');
  }
  deactivate(): void {
    this.setInUse(false);
    this.showMesh(true);
    this.context.hint('');
  }
  key(event: KeyboardEvent): boolean {
    if (event.key !== 'Escape') return false;
    this.pickFeature(undefined, false);
    return true;
  }
  applyTheme(): void {
    this.material.applyTheme(true);
    this.edges.forEach((lines, type) => ((lines.material as LineBasicMaterial).color = themeColor(TYPES[type]!)));
  }
  state(): Record<string, unknown> {
    return { picked: this.picked, planes: this.planes, busy: this.model.busyCorners.length, colours: this.colours, seen: this.seenMaterials, records: this.records.textContent, edges: this.edges.map((lines) => lines.visible), boxes: this.boxes.children.length };
  }
}

