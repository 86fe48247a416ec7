// SPDX-License-Identifier: Apache-2.0
// The scene of a session on the stage: objects at their poses, sheets in their shapes, every contact of every device.
import { Box3, BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry, Quaternion, SphereGeometry, Vector3 } from 'three';
import { ContactMarks } from './contact_marks';
import type { Context } from './context';
import { readArray } from './data';
import { Frame } from './frame';
import { GraphModel } from './graph_model';
import { colorOfNumber } from './number_colors';
import { Runtime, TYPES } from './runtime';
import type { SessionObject, SessionRef, SessionWorld } from './session_data';
import { SurfaceMaterial } from './surface_material';
import { surfaceShape } from './surface_shape';
import { themeColor } from './theme';

const UP = new Vector3(0, 1, 0); // of the stage
const SAMPLES = 200; // moments that say how large the scene is
const REACH = 0.65; // of the scene's size: how far planes and the ground are drawn
const HOLLOW = 0.6; // the share that is left out of what one looks into

interface Shape {
  geometry: BufferGeometry;
  corners?: Uint32Array; // of a graph: of each of the geometry's points its corner
  lines?: Float32Array[]; // its edges, pairs of points
}

interface Placed {
  group: Group;
  mesh: Mesh;
  shape: Shape;
  rest?: Float32Array; // of a sheet
}

interface Marked {
  marks: ContactMarks;
  pad: Mesh | undefined;
}

/** A graph in metres. Sheets move corner by corner. */
async function graphShape(context: Context, session: SessionRef, graph: number): Promise<Shape> {
  const ref = session.graphs[graph];
  if (ref === undefined || ref === null) throw new Error('a graph of the session is missing in the page');
  const runtime = await Runtime.make(context.wasm);
  runtime.open(await readArray(ref));
  const { metresPerUnit } = runtime.header();
  const model = new GraphModel(runtime, new Frame([0, 0, 0], 1 / metresPerUnit, metresPerUnit));
  return { geometry: model.geometry, corners: model.triangleCorners(), lines: model.lines };
}

export class SessionScene {
  readonly frame: Frame;
  readonly objects: Placed[] = [];
  private readonly turned = new Group(); // the scene's up is the stage's
  private readonly metres = new Group(); // world
  private readonly marksGroup = new Group();
  private readonly contacts: Marked[][] = []; // by device
  private readonly materials: SurfaceMaterial[] = []; // by object
  private readonly lineMaterial = new LineBasicMaterial();
  private readonly netMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.3 });
  private readonly groundMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.5 });

  private constructor(
    private readonly context: Context,
    private readonly session: SessionRef,
    private readonly world: SessionWorld,
    shapes: readonly (Shape | undefined)[],
  ) {
    const box = this.bounds(shapes);
    const centre = box.getCenter(new Vector3());
    const size = Math.max(...box.getSize(new Vector3()).toArray()) || 1;
    this.frame = new Frame(centre.toArray(), size, 1);
    this.metres.scale.setScalar(1 / size);
    this.metres.position.copy(centre).divideScalar(-size);
    this.turned.add(this.metres);
    const up = new Vector3(...session.gravity).negate();
    if (up.lengthSq() === 0) up.set(0, 0, 1);
    const turn = new Quaternion().setFromUnitVectors(up.normalize(), UP);
    this.turned.quaternion.copy(turn);
    this.marksGroup.quaternion.copy(turn);
    context.stage.content.add(this.turned);
    context.stage.marks.add(this.marksGroup);
    session.objects.forEach((object, i) => this.place(object, shapes[i]));
    this.addGround();
    this.addContacts();
    this.applyTheme();
  }

  static async make(context: Context, session: SessionRef, world: SessionWorld): Promise<SessionScene> {
    const known = new Map<number, Shape>();
    const shapes: (Shape | undefined)[] = [];
    for (const object of session.objects) {
      if (object.graph === undefined) shapes.push(undefined);
      else {
        const shape = known.get(object.graph) ?? (await graphShape(context, session, object.graph));
        known.set(object.graph, shape);
        shapes.push(object.motion === 'soft' ? { ...shape, geometry: shape.geometry.clone() } : shape);
      }
    }
    return new SessionScene(context, session, world, shapes);
  }

  /** About all that has an end, wherever it comes to. */
  private bounds(shapes: readonly (Shape | undefined)[]): Box3 {
    const { world, session } = this;
    const box = new Box3();
    const step = Math.max(1, Math.floor(world.frames / SAMPLES));
    const radii = session.objects.map((object, i) => this.radius(object, shapes[i]));
    for (let i = 0; i < world.frames; i += step) {
      session.objects.forEach((object, k) => {
        const radius = radii[k]!;
        if (radius === undefined) return;
        const moving = world.moving.indexOf(k);
        const pose = moving < 0 ? object.pose : world.pose(i, moving);
        const place = radius.centre.clone().applyQuaternion(new Quaternion(pose[3], pose[4], pose[5], pose[6])).add(new Vector3(pose[0], pose[1], pose[2]));
        box.expandByPoint(place.clone().addScalar(radius.size)).expandByPoint(place.addScalar(-radius.size));
      });
      for (const device of world.devices) device.pads.forEach((_, k) => box.expandByPoint(new Vector3(...device.contact(i, k).hip)));
    }
    if (box.isEmpty()) box.set(new Vector3(-0.5, -0.5, -0.5), new Vector3(0.5, 0.5, 0.5));
    return box;
  }
  private radius(object: SessionObject, shape: Shape | undefined): { centre: Vector3; size: number } | undefined {
    if (object.surface?.kind === 'plane') return undefined;
    const geometry = shape?.geometry ?? surfaceShape(object.surface!, 1);
    geometry.computeBoundingSphere();
    const { center, radius } = geometry.boundingSphere!;
    return { centre: center.clone().multiplyScalar(object.scale), size: radius * object.scale };
  }

  private place(object: SessionObject, graph: Shape | undefined): void {
    const shape = graph ?? { geometry: surfaceShape(object.surface!, (REACH * this.frame.size) / object.scale) };
    const mesh = new Mesh(shape.geometry, this.materialOf(object));
    const group = new Group();
    group.name = object.name;
    group.add(mesh);
    if (object.motion !== 'soft') {
      for (const [type, pairs] of (shape.lines ?? []).entries()) {
        if (TYPES[type] === 'coplanar' || pairs.length === 0) continue;
        const lines = new LineSegments(new BufferGeometry().setAttribute('position', new BufferAttribute(pairs, 3)), this.lineMaterial);
        group.add(lines);
      }
    }
    this.metres.add(group);
    const placed: Placed = { group, mesh, shape };
    if (object.motion === 'soft') {
      placed.rest = (shape.geometry.getAttribute('position').array as Float32Array).slice();
      mesh.frustumCulled = false;
      group.add(this.net(shape.geometry));
    }
    this.objects.push(placed);
    setPose(group, object.pose, object.scale);
  }

  /** The triangles' sides, which move with the sheet. */
  private net(geometry: BufferGeometry): LineSegments {
    const position = geometry.getAttribute('position') as BufferAttribute;
    const pairs = new Uint32Array(2 * position.count);
    for (let p = 0; p < position.count; ++p) pairs.set([p, p % 3 === 2 ? p - 2 : p + 1], 2 * p);
    const lines = new LineSegments(new BufferGeometry().setAttribute('position', position), this.netMaterial);
    lines.geometry.setIndex(new BufferAttribute(pairs, 1));
    lines.frustumCulled = false;
    return lines;
  }

  /** Several objects have colours of their own; a plane is background. */
  private materialOf(object: SessionObject): SurfaceMaterial {
    const material = new SurfaceMaterial();
    if (object.surface?.hollow) material.setFocus(new Vector3(), 1e9, HOLLOW);
    this.materials.push(material);
    return material;
  }
  private paint(): void {
    const solid = this.session.objects.filter((object) => object.surface?.kind !== 'plane').length;
    this.materials.forEach((material, i) => {
      material.applyTheme(false);
      if (solid > 1 && this.session.objects[i]!.surface?.kind !== 'plane') material.tint(new Color(...colorOfNumber(i)));
    });
  }

  private addGround(): void {
    const { ground } = this.session;
    if (ground === undefined) return;
    const cells = 16;
    const grid = new PlaneGeometry(2 * REACH * this.frame.size, 2 * REACH * this.frame.size, cells, cells);
    const pairs: number[] = [];
    const at = (row: number, column: number): number => row * (cells + 1) + column;
    for (let k = 0; k <= cells; ++k) pairs.push(at(k, 0), at(k, cells), at(0, k), at(cells, k));
    const lines = new LineSegments(grid, this.groundMaterial);
    grid.setIndex(pairs);
    const normal = new Vector3(...ground.normal);
    const centre = new Vector3(...this.frame.centre);
    lines.position.copy(centre).addScaledVector(normal, ground.offset - centre.dot(normal));
    lines.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal);
    this.metres.add(lines);
  }

  private addContacts(): void {
    let most = 0;
    for (const device of this.world.devices) {
      for (let i = 0; i < this.world.frames; ++i) device.pads.forEach((_, k) => (most = Math.max(most, Math.hypot(...device.contact(i, k).force))));
    }
    for (const device of this.world.devices) {
      this.contacts.push(
        device.pads.map((radius) => {
          const marks = new ContactMarks(this.frame);
          marks.setScale(most);
          const pad = radius > 0 ? new Mesh(new SphereGeometry(radius / this.frame.size, 24, 16), new MeshBasicMaterial({ transparent: true, opacity: 0.35 })) : undefined;
          if (pad !== undefined) this.marksGroup.add(pad);
          this.marksGroup.add(marks.group);
          return { marks, pad };
        }),
      );
    }
  }

  /** Everything as it is at frame i. */
  show(i: number): void {
    const { world, session } = this;
    world.moving.forEach((object, k) => setPose(this.objects[object]!.group, world.pose(i, k), session.objects[object]!.scale));
    for (const soft of world.soft) this.bend(soft.object, soft.at(world.time[i]!));
    world.devices.forEach((device, d) => {
      device.pads.forEach((_, k) => {
        const contact = device.contact(i, k);
        const { marks, pad } = this.contacts[d]![k]!;
        const mu = contact.state === 0 ? 0 : session.objects[contact.object]?.mu_static ?? 0;
        const at = marks.update({ ...contact, mu });
        pad?.position.copy(contact.state === 0 ? this.frame.fromMetres(contact.hip) : at);
      });
    });
    this.context.stage.invalidate();
  }

  private bend(object: number, moved: Float32Array): void {
    const { mesh, shape, rest } = this.objects[object]!;
    if (rest === undefined || shape.corners === undefined) return;
    const position = mesh.geometry.getAttribute('position') as BufferAttribute;
    const to = position.array as Float32Array;
    for (let p = 0; p < shape.corners.length; ++p) {
      const corner = shape.corners[p]!;
      for (let k = 0; k < 3; ++k) to[3 * p + k] = rest[3 * p + k]! + moved[3 * corner + k]!;
    }
    position.needsUpdate = true;
  }

  /** Where an object is now, metres, world; and of a sheet how far its farthest corner is from its place. */
  where(object: number): { place: number[]; dent: number } {
    const { group, mesh, rest } = this.objects[object]!;
    const now = mesh.geometry.getAttribute('position').array as Float32Array;
    let dent = 0;
    if (rest !== undefined) for (let p = 0; p < rest.length; p += 3) dent = Math.max(dent, Math.hypot(now[p]! - rest[p]!, now[p + 1]! - rest[p + 1]!, now[p + 2]! - rest[p + 2]!));
    return { place: group.position.toArray(), dent: dent * this.session.objects[object]!.scale };
  }

  set visible(shown: boolean) {
    this.turned.visible = this.marksGroup.visible = shown;
  }

  applyTheme(): void {
    this.paint();
    this.lineMaterial.color = this.netMaterial.color = themeColor('mesh-edge');
    this.groundMaterial.color = themeColor('quiet');
    for (const { marks, pad } of this.contacts.flat()) {
      marks.applyTheme();
      if (pad !== undefined) (pad.material as MeshBasicMaterial).color = themeColor('god');
    }
  }

  dispose(): void {
    this.turned.removeFromParent();
    this.marksGroup.removeFromParent();
  }
}

function setPose(group: Group, pose: ArrayLike<number>, scale: number): void {
  group.position.set(pose[0]!, pose[1]!, pose[2]!);
  group.quaternion.set(pose[3]!, pose[4]!, pose[5]!, pose[6]!).normalize();
  group.scale.setScalar(scale);
}
