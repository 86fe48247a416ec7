// SPDX-License-Identifier: Apache-2.0
// One contact on the stage: HIP, god-object, the spring between them, the force on the hand and the friction cone.
import { BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, DoubleSide, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, type Object3D, SphereGeometry, Vector3 } from 'three';
import type { Frame } from './frame';
import { themeColor } from './theme';

const DOT = 0.009; // radii and lengths, of the object's size
const ARROW = 0.22; // the longest force arrow
const UP = new Vector3(0, 1, 0);

export interface ContactState {
  hip: readonly [number, number, number];
  god: readonly [number, number, number];
  force: readonly [number, number, number];
  normal: readonly [number, number, number]; // zero: not on a face
  mu: number;
  state: number;
  slips: boolean;
}

export class ContactMarks {
  readonly group = new Group();
  private readonly hip = new Mesh(new SphereGeometry(DOT * 0.7, 16, 12), new MeshBasicMaterial({ depthTest: false }));
  private readonly god = new Mesh(new SphereGeometry(DOT, 20, 14), new MeshBasicMaterial({ depthTest: false }));
  private readonly spring = new Line(new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3)), new LineBasicMaterial({ depthTest: false }));
  private readonly cone = new Mesh(new ConeGeometry(1, 1, 48, 1, true), new MeshBasicMaterial({ transparent: true, opacity: 0.32, side: DoubleSide, depthTest: false }));
  private readonly shaft = new Mesh(new CylinderGeometry(0.004, 0.004, 1, 12), new MeshBasicMaterial({ depthTest: false }));
  private readonly tip = new Mesh(new ConeGeometry(0.012, 0.03, 16), new MeshBasicMaterial({ depthTest: false }));
  private largestForce = 1;

  constructor(private readonly frame: Frame) {
    for (const [order, object] of ([this.cone, this.spring, this.shaft, this.tip, this.hip, this.god] as Object3D[]).entries()) {
      object.renderOrder = 10 + order;
      object.frustumCulled = false;
      this.group.add(object);
    }
    this.applyTheme();
  }

  applyTheme(): void {
    const colors: [Mesh | Line, string][] = [[this.hip, 'hip'], [this.spring, 'hip'], [this.god, 'god'], [this.shaft, 'force'], [this.tip, 'force'], [this.cone, 'edge']];
    for (const [object, name] of colors) (object.material as MeshBasicMaterial).color = themeColor(name);
  }

  /** The longest arrow stands for this force. */
  setScale(force: number): void {
    this.largestForce = Math.max(force, 1e-9);
  }

  update(contact: ContactState): Vector3 {
    const hip = this.frame.fromMetres(contact.hip);
    const god = this.frame.fromMetres(contact.god);
    this.hip.position.copy(hip);
    this.god.position.copy(god);
    (this.god.material as MeshBasicMaterial).color = themeColor(contact.state === 0 ? 'free' : contact.slips ? 'vertex' : 'god');
    const ends = this.spring.geometry.getAttribute('position') as BufferAttribute;
    ends.setXYZ(0, hip.x, hip.y, hip.z);
    ends.setXYZ(1, god.x, god.y, god.z);
    ends.needsUpdate = true;
    this.drawForce(god, new Vector3(...contact.force));
    this.drawCone(hip, god, new Vector3(...contact.normal), contact.mu, contact.slips);
    return god;
  }

  /** What is drawn now. */
  state(): Record<string, boolean> {
    const isShown = this.group.visible;
    return { hip: isShown, godObject: isShown, spring: isShown && !this.hip.position.equals(this.god.position), force: isShown && this.shaft.visible, cone: isShown && this.cone.visible };
  }

  private drawForce(at: Vector3, force: Vector3): void {
    const size = force.length();
    const length = (ARROW * Math.min(size, this.largestForce)) / this.largestForce;
    this.shaft.visible = this.tip.visible = length > 1e-3;
    if (!this.shaft.visible) return;
    const direction = force.divideScalar(size);
    this.shaft.scale.set(1, length, 1);
    this.shaft.position.copy(at).addScaledVector(direction, length / 2);
    this.tip.position.copy(at).addScaledVector(direction, length);
    for (const part of [this.shaft, this.tip]) part.quaternion.setFromUnitVectors(UP, direction);
  }

  /** Its apex is the HIP; the god-object sticks while it is inside where the cone meets the face. */
  private drawCone(hip: Vector3, god: Vector3, normal: Vector3, mu: number, slips: boolean): void {
    const depth = god.clone().sub(hip).dot(normal);
    this.cone.visible = depth > 1e-6 && mu > 0;
    if (!this.cone.visible) return;
    this.cone.scale.set(mu * depth, depth, mu * depth);
    this.cone.position.copy(hip).addScaledVector(normal, depth / 2);
    this.cone.quaternion.setFromUnitVectors(UP, normal.clone().negate());
    (this.cone.material as MeshBasicMaterial).color = themeColor(slips ? 'vertex' : 'edge');
  }
}
