// SPDX-License-Identifier: Apache-2.0
// Touch: the pointer moves the HIP, and the runtime, in a Worker at 1 kHz, says what a hand would feel.
import { Vector3 } from 'three';
import workerSource from 'worker:./src/touch_worker.ts';
import { ContactMarks } from './contact_marks';
import type { Context, Tab } from './context';
import { button, checkbox, h, slider } from './dom';
import { short } from './numbers';
import { recordingPanel, timeRecording, type TouchSource } from './recording';
import { STATES, type TouchParams } from './runtime';
import { SlipSound } from './slip_sound';
import { Chart } from './traces';
import { FORCE, type FromWorker, GOD, HIP, SLIP, STATE, T, TICK, TICK_S, type Timing, type ToWorker } from './touch_messages';

const HOVER = 0.02; // of the object's size: how far before the surface the hand is while nothing is pressed
const SHOWN_TICKS = 2000;
const CHART_MS = 60;

/** A stiffness at which pressing by a hundredth of the object gives some newtons. */
function usualStiffness(metres: number): number {
  const wanted = 5 / (0.01 * metres);
  return metres >= 0.02 && metres <= 2 ? 1000 : Number(wanted.toPrecision(1));
}

export class TouchTab implements Tab {
  readonly id = 'touch';
  readonly title = 'Touch';
  readonly element = h('div.tab');
  private readonly worker: Worker;
  private readonly marks: ContactMarks;
  private readonly sound = new SlipSound();
  private readonly params: TouchParams;
  private depth = 0.015; // of the object's size
  private isReady = false;
  private isActive = false;
  private isPressed = false;
  private hasHand = false;
  private recordState: 'no' | 'wanted' | 'on' = 'no';
  private recorded: Float64Array | undefined;
  private cursor = { x: 0, y: 0 };
  private plane = new Vector3();
  private readonly ring = { t: new Float64Array(SHOWN_TICKS), normal: new Float64Array(SHOWN_TICKS), tangential: new Float64Array(SHOWN_TICKS), ratio: new Float64Array(SHOWN_TICKS), count: 0 };
  private lastTick: Float64Array | undefined;
  private lastNormal: Float64Array | undefined;
  private timing: Timing = { stepNs: 0, periodP99Ms: 0 };
  private stepNs = 0; // of the recorded path
  private nextChart = 0;
  private inputs: HTMLInputElement[] = [];
  private readonly readout = h('p.readout', { id: 'readout' });
  private readonly timingLine = h('p.note', { id: 'timing' });
  private readonly recordButton = button('Record', () => this.toggleRecord(), { id: 'record', 'aria-pressed': 'false', title: 'Record (R)' });
  private readonly saved = h('div.saved', { hidden: true });
  private readonly dockElement = h('div.charts');
  private charts: { force: Chart; ratio: Chart } | undefined;
  private readonly listeners: [string, (event: never) => void, AddEventListenerOptions?][];

  constructor(
    private readonly context: Context,
    private readonly source: TouchSource,
  ) {
    this.params = { muStatic: 0.6, muDynamic: 0.4, stiffness: usualStiffness(source.frame.metres), damping: 0 };
    this.marks = new ContactMarks(source.frame);
    this.marks.group.visible = false;
    context.stage.marks.add(this.marks.group);
    const url = URL.createObjectURL(new Blob([workerSource], { type: 'text/javascript' }));
    this.worker = new Worker(url);
    URL.revokeObjectURL(url);
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => this.onMessage(event.data);
    this.worker.onerror = (event) => this.context.hint(`The loop has stopped: ${event.message}`);
    this.send({ kind: 'open', wasm: context.wasm, graph: source.graph, params: this.params });
    this.listeners = [
      ['pointermove', ((event: PointerEvent) => this.onMove(event)) as (event: never) => void],
      ['pointerdown', ((event: PointerEvent) => this.onDown(event)) as (event: never) => void, { capture: true }],
      ['pointerup', ((event: PointerEvent) => this.onUp(event)) as (event: never) => void],
      ['pointercancel', ((event: PointerEvent) => this.onUp(event)) as (event: never) => void],
      ['wheel', ((event: WheelEvent) => this.onWheel(event)) as (event: never) => void, { capture: true, passive: false }],
    ];
    this.build();
  }

  private send(message: ToWorker): void {
    this.worker.postMessage(message);
  }

  // ---- panel

  private build(): void {
    const decade = this.params.stiffness;
    const sliders = [
      slider({ label: 'Stiffness', id: 'stiffness', min: decade / 50, max: decade * 20, value: this.params.stiffness, logarithmic: true, unit: 'N/m', text: short, onchange: (value) => this.setParams({ stiffness: Number(value.toPrecision(3)) }) }),
      slider({ label: 'Static friction', id: 'mu-s', min: 0, max: 2, value: this.params.muStatic, text: (v) => v.toFixed(2), onchange: (value) => this.setFriction('muStatic', Number(value.toFixed(2))) }),
      slider({ label: 'Dynamic friction', id: 'mu-d', min: 0, max: 2, value: this.params.muDynamic, text: (v) => v.toFixed(2), onchange: (value) => this.setFriction('muDynamic', Number(value.toFixed(2))) }),
      slider({ label: 'Damping', id: 'damping', min: 0, max: decade / 100, value: 0, unit: 'N s/m', text: short, onchange: (value) => this.setParams({ damping: Number(value.toPrecision(3)) }) }),
      slider({ label: 'Press depth', id: 'depth', min: 0.001, max: 0.08, value: this.depth, logarithmic: true, unit: 'mm', text: (v) => short(v * this.source.frame.metres * 1000), onchange: (value) => this.setDepth(value) }),
    ];
    this.inputs = sliders.slice(0, 4).map((one) => one.input);
    this.muSliders = { muStatic: sliders[1]!.set, muDynamic: sliders[2]!.set };
    this.depthSlider = sliders[4]!.set;
    this.element.append(
      h('p', {}, 'Press on the surface with the left button and drag. Beside it, or with the right button, you turn the model. The wheel presses deeper.'),
      this.readout,
      ...sliders.map((one) => one.element),
      checkbox('Sound of slip', false, (on) => this.sound.set(on)),
      h('h2', {}, 'Recording'),
      h('div.row', {}, this.recordButton),
      this.saved,
      this.timingLine,
    );
    this.dockElement.append(h('div.chart', { id: 'chart-force' }, h('p.chart-title', {}, 'Force in newtons: ', h('span.key.force', {}, 'normal'), ' and ', h('span.key.edge', {}, 'tangential'))), h('div.chart', { id: 'chart-ratio' }, h('p.chart-title', {}, h('span.key.vertex', {}, 'Tangential over normal force'))));
  }
  private muSliders: { muStatic: (v: number) => void; muDynamic: (v: number) => void } | undefined;
  private depthSlider: ((v: number) => void) | undefined;

  private setParams(change: Partial<TouchParams>): void {
    Object.assign(this.params, change);
    this.send({ kind: 'params', params: this.params });
    this.marks.setScale(this.params.stiffness * this.depth * 2 * this.source.frame.metres);
  }
  /** Static friction is at least dynamic friction: the other one follows. */
  private setFriction(which: 'muStatic' | 'muDynamic', value: number): void {
    this.params[which] = value;
    if (this.params.muStatic < this.params.muDynamic) {
      const other = which === 'muStatic' ? 'muDynamic' : 'muStatic';
      this.params[other] = value;
      this.muSliders?.[other](value);
    }
    this.setParams({});
  }
  private setDepth(value: number): void {
    this.depth = Math.min(0.08, Math.max(0.001, value));
    this.aim(false);
    this.setParams({});
  }

  // ---- the hand

  private ray(): { origin: Vector3; direction: Vector3 } {
    return this.context.stage.rayAt(this.cursor.x, this.cursor.y).ray;
  }
  private surfaceUnder(): Vector3 | undefined {
    const { origin, direction } = this.ray();
    const { frame, runtime } = this.source;
    const met = runtime.cast(frame.toMetres(origin), frame.toMetres(origin.clone().addScaledVector(direction, origin.length() + 2)));
    return met === undefined ? undefined : frame.fromMetres(met.godObject);
  }
  /** Where the ray goes through the plane, parallel to the picture, on which the hand last was. */
  private onPlane(): Vector3 {
    const { origin, direction } = this.ray();
    const forward = this.context.stage.camera.getWorldDirection(new Vector3());
    return origin.clone().addScaledVector(direction, this.plane.clone().sub(origin).dot(forward) / direction.dot(forward));
  }

  /** Sends the hand to where the pointer is. `jump`: it was away, and must not cut through the object. */
  private aim(jump: boolean): boolean {
    if (!this.isActive || !this.isReady) return false;
    const surface = this.surfaceUnder();
    if (surface === undefined && !this.hasHand) return false;
    const place = surface ?? this.onPlane();
    this.plane.copy(place);
    const { direction } = this.ray();
    const along = this.isPressed ? this.depth * this.pressure : -HOVER;
    this.send({ kind: 'target', hip: this.source.frame.toMetres(place.addScaledVector(direction, along)), jump: jump || !this.hasHand });
    this.hasHand = true;
    this.marks.group.visible = true;
    this.context.stage.canvas.classList.add('touching');
    return surface !== undefined;
  }
  private pressure = 1;

  private follow(event: PointerEvent): void {
    this.cursor = { x: event.clientX, y: event.clientY };
    this.pressure = event.pointerType === 'pen' && event.pressure > 0 ? event.pressure * 2 : 1;
  }
  private leave(): void {
    this.hasHand = false;
    this.marks.group.visible = false;
    this.context.stage.canvas.classList.remove('touching');
    this.context.stage.invalidate();
  }
  private onMove(event: PointerEvent): void {
    if (event.buttons > 1 || (event.buttons === 1 && !this.isPressed)) return;
    this.follow(event);
    const isOver = this.aim(false);
    if (!isOver && !this.isPressed && this.recordState === 'no') this.leave();
  }
  private onDown(event: PointerEvent): void {
    if (event.button !== 0 || event.shiftKey) return;
    this.follow(event);
    if (this.surfaceUnder() === undefined) return;
    this.aim(!this.hasHand);
    event.stopImmediatePropagation();
    this.context.stage.canvas.setPointerCapture(event.pointerId);
    this.press(true);
  }
  private onUp(event: PointerEvent): void {
    if (!this.isPressed) return;
    this.follow(event);
    this.press(false);
  }
  private press(on: boolean): void {
    this.isPressed = on;
    this.context.stage.controls.enabled = !on;
    this.aim(false);
  }
  private onWheel(event: WheelEvent): void {
    if (!this.isPressed) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    this.setDepth(this.depth * Math.exp(-event.deltaY * 0.002));
    this.depthSlider?.(this.depth);
  }

  // ---- what comes back

  private onMessage(message: FromWorker): void {
    if (message.kind === 'opened') {
      this.isReady = true;
      this.setParams({});
      if (this.isActive) this.send({ kind: 'run', on: true });
    } else if (message.kind === 'failed') this.context.hint(`The graph cannot be touched: ${message.message}`);
    else if (message.kind === 'recording') {
      this.recordState = 'on';
      this.recordButton.textContent = `Stop (${message.seconds.toFixed(1)} s)`;
    } else if (message.kind === 'recorded') this.showRecording(message.ticks);
    else this.onTicks(message.ticks, message.normals, message.timing);
  }

  private onTicks(ticks: Float64Array, normals: Float64Array, timing: Timing): void {
    const { ring } = this;
    for (let at = 0, n = 0; at < ticks.length; at += TICK, n += 3) {
      const force = [0, 1, 2].map((k) => ticks[at + FORCE + k]!);
      const normal = force.reduce((sum, f, k) => sum + f * normals[n + k]!, 0);
      const size = Math.hypot(...force);
      const i = ring.count++ % SHOWN_TICKS;
      ring.t[i] = ticks[at + T]!;
      ring.normal[i] = normals[n] === 0 && normals[n + 1] === 0 && normals[n + 2] === 0 ? size : normal;
      ring.tangential[i] = Math.sqrt(Math.max(0, size * size - ring.normal[i]! ** 2));
      ring.ratio[i] = ring.normal[i]! > 1e-12 ? ring.tangential[i]! / ring.normal[i]! : 0;
    }
    this.lastTick = ticks.slice(-TICK);
    this.lastNormal = normals.slice(-3);
    this.timing = timing;
    this.context.stage.invalidate();
  }

  private readonly animate = (now: number): boolean => {
    const tick = this.lastTick;
    if (tick === undefined || this.lastNormal === undefined || !this.hasHand) return false;
    const three = (at: number): [number, number, number] => [tick[at]!, tick[at + 1]!, tick[at + 2]!];
    const slips = tick[SLIP] === 1;
    const mu = slips ? this.params.muDynamic : this.params.muStatic;
    this.marks.update({ hip: three(HIP), god: three(GOD), force: three(FORCE), normal: [this.lastNormal[0]!, this.lastNormal[1]!, this.lastNormal[2]!], mu, state: tick[STATE]!, slips });
    const force = Math.hypot(...three(FORCE));
    const last = (this.ring.count - 1) % SHOWN_TICKS;
    this.sound.play(slips ? force / (this.params.stiffness * this.depth * this.source.frame.metres) : 0);
    if (now >= this.nextChart) {
      this.nextChart = now + CHART_MS;
      const state = STATES[tick[STATE]!]!;
      this.readout.textContent = state === 'free' ? 'Free: nothing touched.' : `${slips ? 'Slips' : 'Sticks'} on a ${state}. ${short(force)} N, ratio ${this.ring.ratio[last]!.toFixed(2)}.`;
      this.timingLine.textContent = `A step takes ${short(this.timing.stepNs / 1000)} µs here; 99 % of the ticks come within ${this.timing.periodP99Ms.toFixed(2)} ms.`;
      this.drawCharts();
    }
    return false;
  };

  private drawCharts(): void {
    const { ring } = this;
    const count = Math.min(ring.count, SHOWN_TICKS);
    const from = ring.count % SHOWN_TICKS;
    const inOrder = (values: Float64Array): Float64Array => {
      if (ring.count <= SHOWN_TICKS) return values.slice(0, count);
      const sorted = new Float64Array(count);
      sorted.set(values.subarray(from));
      sorted.set(values.subarray(0, from), SHOWN_TICKS - from);
      return sorted;
    };
    const newest = ring.t[(ring.count - 1) % SHOWN_TICKS]!;
    const t = Float64Array.from({ length: count }, (_, i) => newest - (count - 1 - i) * TICK_S);
    this.charts?.force.set(t, inOrder(ring.normal), inOrder(ring.tangential));
    this.charts?.ratio.set(t, inOrder(ring.ratio));
  }

  // ---- recording

  private toggleRecord(): void {
    const on = this.recordState === 'no';
    this.recordState = on ? 'wanted' : 'no';
    for (const input of this.inputs) input.disabled = on; // a replay has one set of parameters
    this.recordButton.setAttribute('aria-pressed', String(on));
    this.recordButton.textContent = on ? 'Stop' : 'Record';
    if (on) {
      this.saved.hidden = true;
      this.recorded = undefined;
      this.context.hint(this.hasHand ? '' : 'The recording begins when the hand is over the model and touches nothing.');
    }
    this.send({ kind: 'record', on });
  }

  private showRecording(ticks: Float64Array): void {
    this.recorded = ticks;
    this.stepNs = timeRecording(this.source, ticks, this.params);
    this.context.hint('');
    this.saved.hidden = false;
    this.saved.replaceChildren(...recordingPanel(this.source, ticks, this.params, this.stepNs));
    this.context.announce('The recording is ready to be saved.');
  }

  // ---- tab

  activate(): void {
    this.isActive = true;
    const { stage } = this.context;
    for (const [name, listener, options] of this.listeners) stage.canvas.addEventListener(name, listener as unknown as EventListener, options);
    stage.animations.add(this.animate);
    const rectangle = stage.canvas.getBoundingClientRect();
    this.cursor = { x: rectangle.left + rectangle.width / 2, y: rectangle.top + rectangle.height / 2 };
    this.context.dock(this.dockElement);
    this.charts ??= {
      force: new Chart(this.dockElement.querySelector('#chart-force')!, [{ label: 'normal', color: 'force', unit: 'N' }, { label: 'tangential', color: 'edge', unit: 'N' }], 120),
      ratio: new Chart(this.dockElement.querySelector('#chart-ratio')!, [{ label: 'ratio', color: 'vertex', unit: '' }], 120),
    };
    if (this.isReady) this.send({ kind: 'run', on: true });
  }
  deactivate(): void {
    this.isActive = false;
    if (this.recordState !== 'no') this.toggleRecord();
    this.press(false);
    this.leave();
    this.sound.set(false);
    const { stage } = this.context;
    for (const [name, listener, options] of this.listeners) stage.canvas.removeEventListener(name, listener as unknown as EventListener, options);
    stage.animations.delete(this.animate);
    this.context.dock(null);
    this.context.hint('');
    this.send({ kind: 'run', on: false });
  }
  dispose(): void {
    this.worker.terminate();
  }

  key(event: KeyboardEvent): boolean {
    if (event.key === 'r') this.toggleRecord();
    else if (event.key === ' ') {
      if (!this.isPressed && !this.hasHand && !this.aim(true)) this.context.hint('There is no surface in the middle of the picture.');
      else this.press(!this.isPressed);
    } else if (this.isPressed && event.key.startsWith('Arrow')) this.nudge(event.key);
    else if (event.key === 'Escape') this.press(false);
    else return false;
    return true;
  }
  private nudge(key: string): void {
    const step = 6;
    this.cursor.x += key === 'ArrowRight' ? step : key === 'ArrowLeft' ? -step : 0;
    this.cursor.y += key === 'ArrowDown' ? step : key === 'ArrowUp' ? -step : 0;
    this.aim(false);
  }

  applyTheme(): void {
    this.marks.applyTheme();
  }
  state(): Record<string, unknown> {
    const tick = this.lastTick;
    return {
      ready: this.isReady,
      pressed: this.isPressed,
      contact: tick === undefined ? undefined : STATES[tick[STATE]!],
      slips: tick?.[SLIP] === 1,
      force: tick === undefined ? 0 : Math.hypot(tick[FORCE]!, tick[FORCE + 1]!, tick[FORCE + 2]!),
      ticks: this.ring.count,
      recording: this.recordState,
      recorded: this.recorded === undefined ? 0 : this.recorded.length / TICK,
      timing: this.timing,
      recordedStepNs: this.stepNs,
      params: { ...this.params },
    };
  }
}
