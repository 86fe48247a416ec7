// SPDX-License-Identifier: Apache-2.0
// A replay's log on a time line: the contact moves on the stage, force, state and slip are lanes under it.
import { BufferGeometry, Line, LineBasicMaterial, Vector3 } from 'three';
import { ContactMarks } from './contact_marks';
import type { Context, Tab } from './context';
import { h } from './dom';
import type { Frame } from './frame';
import { Lanes } from './lanes';
import { grouped, short } from './numbers';
import { type Runtime, STATES } from './runtime';
import { themeColor } from './theme';
import { Timeline } from './timeline';
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
  private readonly time: Float64Array;
  private readonly lanes: Lanes;
  private readonly timeline: Timeline;
  private readonly readout = h('p.readout', { id: 'readout' });
  private chart: Chart | undefined;

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
    const time = (this.time = Float64Array.from({ length: this.count }, (_, i) => this.value(i, T)));
    this.lanes = new Lanes(time, [{ height: 14, level: (i) => this.value(i, STATE), colors: STATES }, { height: 9, level: (i) => this.value(i, SLIP) - 1, colors: ['force'] }], '', (t) => this.timeline.seekTime(t));
    this.timeline = new Timeline({ time, show: (at) => this.show(at), invalidate: () => context.stage.invalidateMarks() }, h('div.chart', { id: 'chart-log' }, h('p.chart-title', {}, h('span.key.force', {}, 'Force'), this.runtime !== undefined && h('span.key.edge', {}, 'along the face'), ', newtons')), this.lanes.element);
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
  private normal(i: number): readonly [number, number, number] {
    const feature = this.value(i, FEATURE);
    const isOnFace = this.value(i, STATE) === 1 && this.runtime !== undefined && feature < this.runtime.header().nodes;
    return isOnFace ? this.runtime.node(feature).normal : [0, 0, 0];
  }
  /** Along the face; NaN where the contact is on none. */
  private tangential(i: number): number {
    const force = this.three(i, FORCE);
    const normal = this.normal(i);
    const along = force.reduce((sum, f, k) => sum + f * normal[k]!, 0);
    return normal.every((x) => x === 0) ? Number.NaN : Math.sqrt(Math.max(0, this.force(i) ** 2 - along ** 2));
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

  private show(at: number): string {
    const state = this.value(at, STATE);
    const feature = this.value(at, FEATURE);
    const slips = this.value(at, SLIP) === 1;
    this.marks.update({ hip: this.three(at, HIP), god: this.three(at, GOD), force: this.three(at, FORCE), normal: this.normal(at), mu: 0, state, slips });
    const t = this.value(at, T);
    const text = `${t.toFixed(3)} s: ${STATES[state]}${state === 0 ? '' : ` ${feature}, ${slips ? 'slips' : 'sticks'}, ${short(this.force(at))} N`}.`;
    this.readout.textContent = text;
    this.chart?.mark(t);
    this.context.stage.invalidateMarks();
    return text;
  }

  private drawChart(): void {
    const series = [{ label: 'force', color: 'force', unit: 'N' }, { label: 'tangential', color: 'edge', unit: 'N' }];
    this.chart ??= new Chart(this.timeline.element.querySelector('#chart-log')!, this.runtime === undefined ? series.slice(0, 1) : series, 110, (t) => this.timeline.seekTime(t));
    const shown = Array.from({ length: Math.ceil(this.count / this.stride) }, (_, k) => k * this.stride);
    this.chart.set(Float64Array.from(shown, (i) => this.value(i, T)), Float64Array.from(shown, (i) => this.force(i)), Float64Array.from(shown, (i) => this.tangential(i)));
    this.lanes.draw();
  }

  activate(): void {
    this.marks.group.visible = true;
    this.context.stage.animations.add(this.timeline.animate);
    this.context.dock(this.timeline.element);
    requestAnimationFrame(() => this.drawChart());
    this.timeline.seek(this.timeline.at);
  }
  deactivate(): void {
    this.timeline.setPlaying(false);
    this.marks.group.visible = false;
    this.context.stage.animations.delete(this.timeline.animate);
    this.context.dock(null);
  }
  key(event: KeyboardEvent): boolean {
    return this.timeline.key(event);
  }
  applyTheme(): void {
    this.marks.applyTheme();
    (this.path.material as LineBasicMaterial).color = themeColor('god');
    if (this.chart !== undefined) this.drawChart();
  }
  times(): Float64Array {
    return this.time;
  }
  state(): Record<string, unknown> {
    return { ticks: this.count, at: this.timeline.at, playing: this.timeline.isPlaying, contact: STATES[this.value(this.timeline.at, STATE)] };
  }
}
