// SPDX-License-Identifier: Apache-2.0
// The three-dimensional view: renderer, camera and its flights. Draws when something has changed, and rests else.
import { Box3, Group, MathUtils, Matrix4, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { prefersReducedMotion } from './dom';
import { Still } from './still';
import { themeColor } from './theme';

const FLIGHT_MS = 600;
const REST_MS = 250; // without motion: the camera is at rest
const REST_FRAMES = 3; // and for this many frames: slow ones take longer
const MARKS_MS = 33; // between frames in which only marks move, where the processor draws: the loop needs it too
const MOVING_RATIO = 0.7; // of the pixels' side, while the processor draws a view that moves

interface Flight {
  from: Vector3;
  to: Vector3;
  targetFrom: Vector3;
  targetTo: Vector3;
  start: number;
}

/** Undefined where the browser cannot draw: lists, records and forces are there all the same. Without a graphics processor smooth
 * edges cost more than all the rest. The canvas is opaque, which three.js does not ask for: to blend it with the page costs as much
 * as to draw a small model. */
function makeRenderer(): { renderer: WebGLRenderer; isSlow: boolean } | undefined {
  const probe = document.createElement('canvas').getContext('webgl2');
  if (probe === null) return undefined;
  const names = probe.getExtension('WEBGL_debug_renderer_info');
  const name = names === null ? '' : String(probe.getParameter(names.UNMASKED_RENDERER_WEBGL));
  probe.getExtension('WEBGL_lose_context')?.loseContext();
  const isSlow = /swiftshader|llvmpipe|software|basic render/i.test(name);
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('webgl2', { alpha: false, antialias: !isSlow, powerPreference: 'high-performance' });
  if (context === null) return undefined;
  const renderer = new WebGLRenderer({ canvas, context });
  renderer.setPixelRatio(isSlow ? 1 : Math.min(devicePixelRatio, 2));
  return { renderer, isSlow };
}

export class Stage {
  readonly scene = new Scene();
  readonly content = new Group(); // what there is to look at: fit() shows all of it
  readonly marks = new Group(); // what moves over it
  readonly camera = new PerspectiveCamera(40, 1, 1e-4, 50);
  readonly controls: OrbitControls;
  readonly canvas: HTMLCanvasElement;
  readonly resolution = new Vector2(1, 1); // of fat lines, CSS pixels
  frames = 0;
  wholeFrames = 0; // of them those in which more than the marks was drawn
  /** Called before each frame with the time; true: draw again after it. */
  readonly animations = new Set<(now: number) => boolean>();
  /** Called in each frame in which the camera moves, and when it has come to rest: what is large may be drawn coarsely meanwhile. */
  readonly moving = new Set<(moves: boolean) => void>();
  /** Drawn by the processor. */
  readonly isSlow: boolean;
  private readonly renderer: WebGLRenderer | undefined;
  private readonly drawnFrom = new Matrix4(); // the camera's place in the last frame
  private flight: Flight | undefined;
  private pending = false;
  private waits = false; // for marks alone
  private isStale = true; // more than marks has changed
  private isMoving = false;
  private movedMs = 0;
  private restFrames = 0;
  private lastDrawn = 0;
  private readonly still = new Still();

  constructor(private readonly holder: HTMLElement) {
    const made = makeRenderer();
    this.renderer = made?.renderer;
    this.isSlow = made?.isSlow ?? false;
    this.canvas = this.renderer?.domElement ?? document.createElement('canvas');
    if (this.renderer === undefined) this.canvas.className = 'blank';
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', 'The model. Arrow keys turn it, plus and minus come nearer or go away, F shows all of it.');
    holder.append(this.canvas);
    this.scene.add(this.content, this.marks);
    this.camera.position.set(1.1, 0.7, 1.7);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = false;
    this.controls.minDistance = 1e-4;
    this.controls.maxDistance = 20;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.invalidate());
    this.controls.addEventListener('start', () => (this.flight = undefined));
    this.canvas.addEventListener('keydown', (event) => this.onKey(event));
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    this.applyTheme();
  }

  applyTheme(): void {
    this.scene.background = themeColor('stage');
    this.invalidate();
  }

  invalidate(): void {
    this.isStale = true;
    this.request();
  }
  /** Only `marks` have changed, none of which is hidden by what is not. */
  invalidateMarks(): void {
    if (this.pending || this.waits) return;
    const wait = this.isSlow ? this.lastDrawn + MARKS_MS - performance.now() : 0;
    if (wait <= 0) {
      this.request();
      return;
    }
    this.waits = true;
    setTimeout(() => {
      this.waits = false;
      this.request();
    }, wait);
  }
  private request(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame((now) => this.draw(now));
  }

  /** One frame, now: for a picture, and to measure. */
  drawNow(): void {
    this.renderer?.render(this.scene, this.camera);
  }

  private draw(now: number): void {
    this.pending = false;
    const flies = this.fly(now);
    let again = false;
    for (const animation of this.animations) again = animation(now) || again;
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance * 0.01, 1e-5);
    this.camera.far = distance + 10;
    this.camera.updateProjectionMatrix();
    this.noteMotion(now, flies);
    if (this.renderer !== undefined) this.render(this.renderer);
    this.lastDrawn = now;
    ++this.frames;
    if (flies) this.invalidate();
    else if (again) this.invalidateMarks();
  }

  private render(renderer: WebGLRenderer): void {
    if (this.isStale || !this.isSlow) {
      this.isStale = false;
      this.still.drop();
      renderer.render(this.scene, this.camera);
      ++this.wholeFrames;
      return;
    }
    if (this.still.isKept) this.still.draw(renderer);
    else {
      this.scene.remove(this.marks);
      renderer.render(this.scene, this.camera);
      this.scene.add(this.marks);
      this.still.keep(renderer);
      ++this.wholeFrames;
    }
    renderer.autoClear = false;
    renderer.render(this.marks, this.camera);
    renderer.autoClear = true;
  }

  private noteMotion(now: number, flies: boolean): void {
    this.camera.updateMatrixWorld();
    const moved = flies || !this.drawnFrom.equals(this.camera.matrixWorld);
    this.drawnFrom.copy(this.camera.matrixWorld);
    if (!moved) return;
    this.isStale = true;
    this.movedMs = now;
    this.restFrames = 0;
    if (!this.isMoving) requestAnimationFrame(this.awaitRest);
    this.setMoving(true);
  }
  private readonly awaitRest = (now: number): void => {
    const isAtRest = now - this.movedMs >= REST_MS && ++this.restFrames > REST_FRAMES;
    if (!isAtRest) {
      requestAnimationFrame(this.awaitRest);
      return;
    }
    this.setMoving(false);
    this.invalidate();
  };
  private setMoving(moves: boolean): void {
    if (this.isSlow && moves !== this.isMoving) this.renderer?.setPixelRatio(moves ? MOVING_RATIO : 1);
    this.isMoving = moves;
    for (const change of this.moving) change(moves);
  }

  private fly(now: number): boolean {
    const flight = this.flight;
    if (flight === undefined) return false;
    const share = prefersReducedMotion() ? 1 : MathUtils.clamp((now - flight.start) / FLIGHT_MS, 0, 1);
    const eased = share * share * (3 - 2 * share);
    this.controls.target.lerpVectors(flight.targetFrom, flight.targetTo, eased);
    this.camera.position.lerpVectors(flight.from, flight.to, eased);
    this.camera.lookAt(this.controls.target);
    this.controls.update();
    if (share < 1) return true;
    this.flight = undefined;
    return false;
  }

  /** From how far a ball fills the picture. */
  distanceFor(radius: number): number {
    return (radius * 1.15) / Math.sin(MathUtils.degToRad(this.camera.fov / 2)) / Math.min(1, this.camera.aspect);
  }
  /** Where to look from: along the normal, but not straight, since a glance from the side shows the shape; from where the camera
   * is now where there is no normal. */
  approach(normal?: Vector3): Vector3 {
    const back = this.camera.position.clone().sub(this.controls.target).normalize();
    if (normal === undefined || normal.lengthSq() === 0) return back;
    const direction = normal.clone().normalize().multiplyScalar(1.4).add(back).normalize();
    return direction.lengthSq() > 0.5 ? direction : back;
  }
  /** Flies to where a ball fills the picture, seen from `direction`. */
  flyTo(centre: Vector3, radius: number, direction = this.approach()): void {
    const distance = this.distanceFor(radius);
    this.flight = {
      from: this.camera.position.clone(),
      to: centre.clone().addScaledVector(direction, distance),
      targetFrom: this.controls.target.clone(),
      targetTo: centre.clone(),
      start: performance.now(),
    };
    this.invalidate();
  }

  /** Pixels drawn per pixel of the page. */
  get pixelRatio(): number {
    return this.renderer?.getPixelRatio() ?? 0;
  }
  get isBlank(): boolean {
    return this.renderer === undefined;
  }
  get isFlying(): boolean {
    return this.flight !== undefined;
  }

  fit(): void {
    const box = new Box3();
    for (const child of this.content.children) if (child.visible) box.expandByObject(child);
    const centre = box.isEmpty() ? new Vector3() : box.getCenter(new Vector3());
    this.flyTo(centre, box.isEmpty() ? 1 : box.getSize(new Vector3()).length() * 0.42);
  }

  /** The ray through a place of the canvas, in pixels of the page. */
  rayAt(clientX: number, clientY: number): Raycaster {
    const rectangle = this.canvas.getBoundingClientRect();
    const place = new Vector2(((clientX - rectangle.left) / rectangle.width) * 2 - 1, 1 - ((clientY - rectangle.top) / rectangle.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(place, this.camera);
    return ray;
  }

  /** Where a point of the stage is seen, in pixels of the page. */
  seenAt(point: Vector3): { x: number; y: number } {
    const rectangle = this.canvas.getBoundingClientRect();
    const p = point.clone().project(this.camera);
    return { x: rectangle.left + ((p.x + 1) / 2) * rectangle.width, y: rectangle.top + ((1 - p.y) / 2) * rectangle.height };
  }

  turn(right: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const distance = offset.length();
    const pitch = MathUtils.clamp(Math.asin(offset.y / distance) + up, -1.55, 1.55);
    const yaw = Math.atan2(offset.x, offset.z) + right;
    offset.set(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)).multiplyScalar(distance);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }

  zoom(factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.invalidate();
  }

  private onKey(event: KeyboardEvent): void {
    const step = 0.12;
    const moves: Record<string, () => void> = {
      ArrowLeft: () => this.turn(-step, 0),
      ArrowRight: () => this.turn(step, 0),
      ArrowUp: () => this.turn(0, step),
      ArrowDown: () => this.turn(0, -step),
      '+': () => this.zoom(0.85),
      '=': () => this.zoom(0.85),
      '-': () => this.zoom(1 / 0.85),
    };
    const move = moves[event.key];
    if (move === undefined || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    move();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width === 0 || height === 0) return;
    this.renderer?.setSize(width, height);
    this.resolution.set(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.isStale = true;
    if (this.renderer !== undefined) this.render(this.renderer);
  }
}
