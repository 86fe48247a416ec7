// SPDX-License-Identifier: Apache-2.0
// A replay's log on a time line: the contact moves on the stage, force, state and slip are lanes under it.
import { BufferGeometry, Line, LineBasicMaterial, Vector3 } from 'three';
import { ContactMarks } from './contact_marks';
import type { Context, Tab } from './context';
import { button, checkbox, h } from './dom';
import type { Frame } from './frame';
import { grouped, short } from './numbers';
import { type Runtime, STATES } from './runtime';
import { cssColor, themeColor } from './theme';
import { FEATURE, FORCE, GOD, HIP, SLIP, STATE, T, TICK } from './touch_messages';
import { Chart } from './traces';

const MOST_POINTS = 4000; // of the charts and the path: what a screen can show

export class LogTab implements Tab {
  readonly id = 'log';
  readonly title = 'Log';
  readonly element = h('div.tab');
  private readonly marks: ContactMarks;
  private readonly path: Line;
  private readonly count: number;
  private readonly dockElement = h('div.timeline');
  private readonly lane = h('canvas.lane', { height: 26, 'aria-hidden': 'true' });
  private readonly scrubber: HTMLInputElement;
  private readonly playButton = button('Play', () => this.setPlaying(!this.isPlaying), { id: 'play', title: 'Play or pause (Space)' });
  private readonly readout = h('p.readout', { id: 'readout' });
  private chart: Chart | undefined;
  private at = 0;
  private speed = 1;
  private loops = false;
  private isPlaying = false;
  private lastMs = 0;
  private exact = 0; // seconds

  constructor(
    private readonly context: Context,
    private readonly ticks: Float64Array,
    private readonly frame: Frame,
    private readonly runtime: Runtime | undefined,
    name: string,
  ) {
    this.count = ticks.length / TICK;
    this.marks = new ContactMarks(frame);
    this.marks.setScale(this.largestForce());
    this.path = new Line(this.pathGeometry(), new LineBasicMaterial({ depthTest: false, transparent: true, opacity: 0.8 }));
    this.path.renderOrder = 5;
    this.marks.group.add(this.path);
    this.marks.group.visible = false;
    context.stage.marks.add(this.marks.group);
    this.scrubber = h('input', { type: 'range', id: 'scrub', min: '0', max: String(Math.max(0, this.count - 1)), step: '1', value: '0', 'aria-label': 'Time', oninput: () => this.seek(Number(this.scrubber.value)) });
    const speed = h('select', { id: 'speed', 'aria-label': 'Speed', onchange: () => (this.speed = Number(speed.value)) });
    for (const value of [0.01, 0.1, 0.25, 1, 4]) speed.append(h('option', { value: String(value), selected: value === 1 }, `${value} x`));
    this.dockElement.append(h('div.row', {}, this.playButton, speed, checkbox('Loop', false, (on) => (this.loops = on)), this.scrubber), h('div.chart', { id: 'chart-log' }), this.lane);
    this.element.append(this.summary(name), this.readout);
    this.applyTheme();
  }

  private value(i: number, k: number): number {
    return this.ticks[i * TICK + k]!;
  }
  private three(i: number, k: number): [number, number, number] {
    return [this.value(i, k), this.value(i, k + 1), this.value(i, k + 2)];
  }
  private force(i: number): number {
    return Math.hypot(...this.three(i, FORCE));
  }
  private largestForce(): number {
    let most = 0;
    for (let i = 0; i < this.count; ++i) most = Math.max(most, this.force(i));
    return most;
  }
  private get stride(): number {
    return Math.max(1, Math.ceil(this.count / MOST_POINTS));
  }

  private summary(name: string): HTMLElement {
    const inState = [0, 0, 0, 0];
    let slipping = 0;
    for (let i = 0; i < this.count; ++i) {
      ++inState[this.value(i, STATE)]!;
      slipping += this.value(i, SLIP);
    }
    const rows = STATES.map((state, k) => h('tr', {}, h('th', { scope: 'row' }, h(`span.key.${state}`, {}, state)), h('td', {}, grouped(inState[k]!))));
    const seconds = this.value(this.count - 1, T) - this.value(0, T);
    return h('section', {}, h('p.counts', {}, `${name.replace(/^.*\//, '')}: ${grouped(this.count)} ticks, ${short(seconds)} s, ${grouped(slipping)} slipping, at most ${short(this.largestForce())} N.`), h('h2', {}, 'Ticks by state'), h('table', {}, h('tbody', {}, ...rows)), h('h2', {}, 'Now'));
  }

  private pathGeometry(): BufferGeometry {
    const points: Vector3[] = [];
    for (let i = 0; i < this.count; i += this.stride) points.push(this.frame.fromMetres(this.three(i, GOD)));
    return new BufferGeometry().setFromPoints(points);
  }

  // ---- time

  private setPlaying(on: boolean): void {
    this.isPlaying = on;
    this.playButton.textContent = on ? 'Pause' : 'Play';
    this.lastMs = performance.now();
    if (on && this.at >= this.count - 1) this.seek(0);
    this.exact = this.value(this.at, T);
    this.context.stage.invalidate();
  }

  private readonly animate = (now: number): boolean => {
    if (!this.isPlaying) return false;
    this.exact += ((now - this.lastMs) / 1000) * this.speed;
    this.lastMs = now;
    let i = this.at;
    while (i + 1 < this.count && this.value(i + 1, T) <= this.exact) ++i;
    if (i >= this.count - 1) {
      if (this.loops) {
        i = 0;
        this.exact = this.value(0, T);
      } else this.setPlaying(false);
    }
    this.seek(i, true);
    return this.isPlaying;
  };

  seek(i: number, fromPlay = false): void {
    this.at = Math.min(this.count - 1, Math.max(0, i));
    if (!fromPlay) this.exact = this.value(this.at, T);
    this.scrubber.value = String(this.at);
    const state = this.value(this.at, STATE);
    const feature = this.value(this.at, FEATURE);
    const slips = this.value(this.at, SLIP) === 1;
    const normal = state === 1 && this.runtime !== undefined && feature < this.runtime.header().nodes ? this.runtime.node(feature).normal : ([0, 0, 0] as const);
    this.marks.update({ hip: this.three(this.at, HIP), god: this.three(this.at, GOD), force: this.three(this.at, FORCE), normal, mu: 0, state, slips });
    const t = this.value(this.at, T);
    this.readout.textContent = `${t.toFixed(3)} s: ${STATES[state]}${state === 0 ? '' : ` ${feature}, ${slips ? 'slips' : 'sticks'}, ${short(this.force(this.at))} N`}.`;
    this.scrubber.setAttribute('aria-valuetext', this.readout.textContent);
    this.chart?.mark(t);
    this.context.stage.invalidate();
  }

  private drawChart(): void {
    this.chart ??= new Chart(this.dockElement.querySelector('#chart-log')!, [{ label: 'force', color: 'force', unit: 'N' }], 110, (t) => this.seekTime(t));
    const shown = Array.from({ length: Math.ceil(this.count / this.stride) }, (_, k) => k * this.stride);
    this.chart.set(Float64Array.from(shown, (i) => this.value(i, T)), Float64Array.from(shown, (i) => this.force(i)));
    this.drawLane();
  }
  private seekTime(t: number): void {
    let low = 0;
    let high = this.count - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.value(middle, T) < t) low = middle + 1;
      else high = middle;
    }
    this.seek(low);
  }

  /** State above, slip below, a column a pixel; over the chart's own width. */
  private drawLane(): void {
    const width = Math.max(1, this.lane.clientWidth);
    this.lane.width = width;
    const context = this.lane.getContext('2d')!;
    for (let x = 0; x < width; ++x) {
      const i = Math.floor((x / width) * this.count);
      context.fillStyle = cssColor(STATES[this.value(i, STATE)]!);
      context.fillRect(x, 0, 1, 14);
      if (this.value(i, SLIP) === 1) {
        context.fillStyle = cssColor('force');
        context.fillRect(x, 17, 1, 9);
      }
    }
  }

  activate(): void {
    this.marks.group.visible = true;
    this.context.stage.animations.add(this.animate);
    this.context.dock(this.dockElement);
    requestAnimationFrame(() => this.drawChart());
    this.seek(this.at);
  }
  deactivate(): void {
    this.setPlaying(false);
    this.marks.group.visible = false;
    this.context.stage.animations.delete(this.animate);
    this.context.dock(null);
  }
  key(event: KeyboardEvent): boolean {
    if (event.key === ' ') this.setPlaying(!this.isPlaying);
    else if (event.key === ',') this.seek(this.at - 1);
    else if (event.key === '.') this.seek(this.at + 1);
    else return false;
    return true;
  }
  applyTheme(): void {
    this.marks.applyTheme();
    (this.path.material as LineBasicMaterial).color = themeColor('god');
    if (this.chart !== undefined) this.drawChart();
  }
  state(): Record<string, unknown> {
    return { ticks: this.count, at: this.at, playing: this.isPlaying, contact: STATES[this.value(this.at, STATE)] };
  }
}
