// SPDX-License-Identifier: Apache-2.0
// Touch: the pointer moves the HIP, and the runtime, in a Worker at 1 kHz, says what a hand would feel.
import { Vector3 } from 'three';
import workerSource from 'worker:./src/touch_worker.ts';
import { ContactMarks } from './contact_marks';
import type { Context, Tab } from './context';
import { button, checkbox, h } from './dom';
import { GamepadReader } from './gamepad';
import { short } from './numbers';
import { recordingPanel, timeRecording, type TouchSource } from './recording';
import { NONE, STATES } from './runtime';
import { SlipSound } from './slip_sound';
import { FEATURE, FORCE, type FromWorker, GOD, HIP, SLIP, STATE, TICK, type Timing, type ToWorker } from './touch_messages';
import { TouchSettings } from './touch_settings';
import { TouchTraces } from './touch_traces';

const HOVER = 0.02; // of the object's size: how far before the surface the hand is while nothing is pressed
const CHART_MS = { slow: 160, fast: 60 };
const PAD_PIXELS_PER_S = 420; // of the hand at full tilt
const PAD_TURN_PER_S = 1.8; // radians of the view

export class TouchTab implements Tab {
  readonly id = 'touch';
  readonly title = 'Touch';
  readonly element = h('div.tab');
  private readonly worker: Worker;
  private readonly marks: ContactMarks;
  private readonly sound = new SlipSound();
  private readonly settings: TouchSettings;
  private isReady = false;
  private isActive = false;
  private isPressed = false;
  private hasHand = false;
  private recordState: 'no' | 'wanted' | 'on' = 'no';
  private recorded: Float64Array | undefined;
  private cursor = { x: 0, y: 0 };
  private plane = new Vector3();
  private lastTick: Float64Array | undefined;
  private lastNormal: Float64Array | undefined;
  private timing: Timing = { stepNs: 0, periodP99Ms: 0 };
  private stepNs = 0; // of the recorded path
  private nextChart = 0;
  private readonly traces = new TouchTraces();
  private readonly gamepad = new GamepadReader();
  private padPresses = false;
  private lastMs = 0;
  private staysInPlane = false;
  private readonly readout = h('p.readout', { id: 'readout' });
  private readonly timingLine = h('p.note', { id: 'timing' });
  private readonly recordButton = button('Record', () => this.toggleRecord(), { id: 'record', 'aria-pressed': 'false', title: 'Record (R)' });
  private readonly saved = h('div.saved', { hidden: true });
  private readonly listeners: [string, (event: never) => void, AddEventListenerOptions?][];

  constructor(
    private readonly context: Context,
    private readonly source: TouchSource,
  ) {
    this.settings = new TouchSettings(source.runtime, source.frame.metres, {
      params: (params) => {
        this.send({ kind: 'params', params });
        this.marks.setScale(params.stiffness * this.settings.depth * 2 * source.frame.metres);
      },
      depth: () => this.aim(false),
      hand: (metresPerS) => this.send({ kind: 'hand', metresPerS }),
    });
    this.marks = new ContactMarks(source.frame);
    this.marks.group.visible = false;
    context.stage.marks.add(this.marks.group);
    const url = URL.createObjectURL(new Blob([workerSource], { type: 'text/javascript' }));
    this.worker = new Worker(url);
    URL.revokeObjectURL(url);
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => this.onMessage(event.data);
    this.worker.onerror = (event) => this.context.hint(`The loop has stopped: ${event.message}`);
    this.send({ kind: 'open', wasm: context.wasm, graph: source.graph, params: this.settings.params });
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
    this.element.append(
      h('p', {}, 'Press on the surface with the left button and drag. Beside it, or with the right button, you turn the model. The wheel presses deeper. A pen presses by its pressure, a gamepad by its right trigger.'),
      this.readout,
      this.ways(),
      this.settings.element,
      checkbox('Sound of slip', false, (on) => this.sound.set(on), 'sound'),
      h('h2', {}, 'Recording'),
      h('div.row', {}, this.recordButton),
      this.saved,
      this.timingLine,
    );
  }

  // Where the hand goes while it is dragged.
  private ways(): HTMLElement {
    const choices = ([['surface', 'along the surface'], ['plane', 'in a plane before the eye']] as const).map(([value, text]) => {
      const radio = h('input', { type: 'radio', name: 'way', value, id: `way-${value}`, checked: value === 'surface', onchange: () => (this.staysInPlane = value === 'plane') });
      return h('label.check', {}, radio, text);
    });
    return h('div.row', { role: 'radiogroup', 'aria-label': 'Where the hand is dragged' }, 'Drag ', ...choices);
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
    const isHeld = this.isPressed && this.staysInPlane && this.hasPlane;
    const surface = isHeld ? undefined : this.surfaceUnder();
    if (surface === undefined && !this.hasHand) return false;
    const place = surface ?? this.onPlane();
    if (!isHeld) this.plane.copy(place);
    this.hasPlane = this.isPressed;
    const { direction } = this.ray();
    const along = this.isPressed ? this.settings.depth * this.pressure : -HOVER;
    this.send({ kind: 'target', hip: this.source.frame.toMetres(place.addScaledVector(direction, along)), jump: jump || !this.hasHand });
    this.hasHand = true;
    this.marks.group.visible = true;
    this.context.stage.canvas.classList.add('touching');
    return surface !== undefined || isHeld;
  }
  private hasPlane = false; // that in which the hand is dragged
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
    this.settings.scaleDepth(Math.exp(-event.deltaY * 0.002));
  }

  // ---- what comes back

  private onMessage(message: FromWorker): void {
    if (message.kind === 'opened') {
      this.isReady = true;
      this.settings.set({});
      if (this.isActive) this.send({ kind: 'run', on: true });
    } else if (message.kind === 'failed') this.context.hint(`The graph cannot be touched: ${message.message}`);
    else if (message.kind === 'recording') {
      if (this.recordState === 'no') return; // sent before the loop heard of the stop
      this.recordState = 'on';
      this.recordButton.textContent = `Stop (${message.seconds.toFixed(1)} s)`;
    } else if (message.kind === 'recorded') this.showRecording(message.ticks);
    else this.onTicks(message.ticks, message.normals, message.timing);
  }

  private onTicks(ticks: Float64Array, normals: Float64Array, timing: Timing): void {
    this.traces.add(ticks, normals);
    this.lastTick = ticks.slice(-TICK);
    this.lastNormal = normals.slice(-3);
    this.timing = timing;
    this.context.stage.invalidateMarks();
  }

  private readonly animate = (now: number): boolean => {
    const usesPad = this.readGamepad(now);
    const tick = this.lastTick;
    if (tick === undefined || this.lastNormal === undefined || !this.hasHand) return usesPad;
    const three = (at: number): [number, number, number] => [tick[at]!, tick[at + 1]!, tick[at + 2]!];
    const slips = tick[SLIP] === 1;
    const mu = this.settings.mu(tick[STATE] === 1 ? tick[FEATURE]! : NONE, slips);
    this.marks.update({ hip: three(HIP), god: three(GOD), force: three(FORCE), normal: [this.lastNormal[0]!, this.lastNormal[1]!, this.lastNormal[2]!], mu, state: tick[STATE]!, slips });
    const force = Math.hypot(...three(FORCE));
    this.sound.play(slips ? force / (this.settings.params.stiffness * this.settings.depth * this.source.frame.metres) : 0);
    if (now >= this.nextChart) {
      this.nextChart = now + CHART_MS[this.context.stage.isSlow ? 'slow' : 'fast'];
      const state = STATES[tick[STATE]!]!;
      this.readout.textContent = state === 'free' ? 'Free: nothing touched.' : `${slips ? 'Slips' : 'Sticks'} on a ${state}. ${short(force)} N, ratio ${this.traces.ratio.toFixed(2)}.`;
      this.timingLine.textContent = `A step takes ${short(this.timing.stepNs / 1000)} µs here; 99 % of the ticks come within ${this.timing.periodP99Ms.toFixed(2)} ms.`;
      this.traces.draw();
    }
    return usesPad;
  };

  /** The left stick moves the hand, the right one the view; the trigger presses. True: there is one. */
  private readGamepad(now: number): boolean {
    const seconds = Math.min(0.1, Math.max(0, (now - this.lastMs) / 1000));
    this.lastMs = now;
    const pad = this.isActive ? this.gamepad.read() : undefined;
    if (pad === undefined) return false;
    if (pad.record) this.toggleRecord();
    if (pad.view[0] !== 0 || pad.view[1] !== 0) this.context.stage.turn(pad.view[0] * PAD_TURN_PER_S * seconds, pad.view[1] * PAD_TURN_PER_S * seconds);
    const presses = pad.pressure > 0.02;
    const moves = pad.hand[0] !== 0 || pad.hand[1] !== 0;
    if (moves) {
      this.cursor.x += pad.hand[0] * PAD_PIXELS_PER_S * seconds;
      this.cursor.y += pad.hand[1] * PAD_PIXELS_PER_S * seconds;
    }
    if (presses) this.pressure = pad.pressure;
    if (presses !== this.padPresses) {
      this.padPresses = presses;
      if (presses && !this.hasHand) this.aim(true);
      this.press(presses);
    } else if (moves || presses) this.aim(false);
    return true;
  }

  // ---- recording

  private toggleRecord(): void {
    const on = this.recordState === 'no';
    this.recordState = on ? 'wanted' : 'no';
    this.settings.lock(on); // a replay has one set of parameters
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
    this.stepNs = timeRecording(this.source, ticks, this.settings.params);
    this.context.hint('');
    this.saved.hidden = false;
    this.saved.replaceChildren(...recordingPanel(this.source, ticks, this.settings.params, this.stepNs));
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
    this.context.dock(this.traces.element);
    this.traces.begin();
    this.settings.draw();
    addEventListener('gamepadconnected', this.onPad);
    if (this.gamepad.isThere) this.onPad();
    if (this.isReady) this.send({ kind: 'run', on: true });
  }
  private readonly onPad = (): void => {
    this.context.hint('Gamepad: the left stick moves the hand, the right one the view, the right trigger presses, Start records.');
    this.context.stage.invalidate();
  };
  deactivate(): void {
    this.isActive = false;
    removeEventListener('gamepadconnected', this.onPad);
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
    this.settings.draw();
    this.traces.draw();
  }
  state(): Record<string, unknown> {
    const tick = this.lastTick;
    return {
      ready: this.isReady,
      pressed: this.isPressed,
      contact: tick === undefined ? undefined : STATES[tick[STATE]!],
      slips: tick?.[SLIP] === 1,
      force: tick === undefined ? 0 : Math.hypot(tick[FORCE]!, tick[FORCE + 1]!, tick[FORCE + 2]!),
      ticks: this.traces.count,
      ratio: this.traces.ratio,
      hip: tick === undefined ? undefined : [...tick.slice(HIP, HIP + 3)],
      godObject: tick === undefined ? undefined : [...tick.slice(GOD, GOD + 3)],
      seen: this.marks.state(),
      loudness: this.sound.loudness,
      gamepad: this.gamepad.isThere,
      handSpeed: this.settings.handSpeed,
      recording: this.recordState,
      recorded: this.recorded === undefined ? 0 : this.recorded.length / TICK,
      timing: this.timing,
      recordedStepNs: this.stepNs,
      params: structuredClone(this.settings.params),
    };
  }
}
