// SPDX-License-Identifier: Apache-2.0
// A session on a time line: the scene moves; force, state, slip, the safety gate and faults of every device are lanes under it.
import type { Context, Tab } from './context';
import { button, h, replaceChildren } from './dom';
import { type Lane, Lanes } from './lanes';
import { grouped, short } from './numbers';
import { STATES } from './runtime';
import { PHASES, type SessionDevice, type SessionRef, SessionWorld } from './session_data';
import { SessionScene } from './session_scene';
import { Timeline } from './timeline';
import { Chart } from './traces';

const MOST_POINTS = 4000; // of the chart: what a screen can show
const MOST_EVENTS = 200;
const SERIES = ['force', 'edge', 'vertex', 'god'] as const; // colours of devices, over and over
const PHASE_COLORS = ['free', 'warning', 'god', 'warning'] as const;

interface Event {
  at: number;
  text: string;
  isFault: boolean;
}

export class SessionTab implements Tab {
  readonly id = 'log';
  readonly title = 'Session';
  readonly element = h('div.tab');
  private readonly body = h('div');
  private shown: { world: SessionWorld; scene: SessionScene; timeline: Timeline; lanes: Lanes[]; rows: HTMLElement[]; index: number } | undefined;
  private chart: Chart | undefined;
  private isActive = false;

  constructor(
    private readonly context: Context,
    private readonly session: SessionRef,
    name: string,
  ) {
    const remarks = session.remarks.map((remark) => h('p.remark', {}, remark));
    this.element.append(h('p.counts', {}, `${name.replace(/^.*\//, '')}: replayed, ${session.same ? 'every output the same bit for bit' : 'not all of it is as it was'}.`), ...remarks);
    if (session.worlds.length > 1) this.element.append(this.worldChoice());
    this.element.append(this.body);
  }

  // Devices that do not share their scene have one each.
  private worldChoice(): HTMLElement {
    const select = h('select', { id: 'world', 'aria-label': 'Device', onchange: () => void this.showWorld(Number(select.value)) });
    for (const [i, world] of this.session.worlds.entries()) select.append(h('option', { value: String(i) }, world.devices.map((device) => device.name).join(', ')));
    return h('label.field', {}, 'Each device has a scene of its own. Shown: ', select);
  }

  async showWorld(index: number): Promise<void> {
    const world = await SessionWorld.read(this.session.worlds[index]!);
    const wasActive = this.isActive;
    this.deactivate();
    this.shown?.scene.dispose();
    this.chart = undefined;
    if (world.frames === 0) {
      this.shown = undefined;
      replaceChildren(this.body, h('p.note', {}, 'The log has no tick of this device.'));
      return;
    }
    const scene = await SessionScene.make(this.context, this.session, world);
    const seek = (t: number): void => this.shown?.timeline.seekTime(t);
    const lanes = world.devices.map((device) => new Lanes(world.time, this.lanesOf(device), device.name, seek));
    const timeline = new Timeline({ time: world.time, show: (at) => this.show(at), invalidate: () => this.context.stage.invalidate() }, h('div.chart', { id: 'chart-session' }), h('div.lane-list', {}, ...lanes.map((one) => one.element)));
    const rows = world.devices.map(() => h('tr'));
    this.shown = { world, scene, timeline, lanes, rows, index };
    replaceChildren(this.body, ...this.panel(world, rows));
    scene.visible = wasActive;
    if (wasActive) this.activate();
    else timeline.seek(0);
  }

  private lanesOf(device: SessionDevice): Lane[] {
    return [
      { height: 12, level: (i) => device.state(i), colors: STATES },
      { height: 6, level: (i) => (device.slips(i) ? 0 : -1), colors: ['force'] },
      { height: 8, level: (i) => device.phase(i), colors: PHASE_COLORS },
      { height: 6, level: (i) => (this.isFault(device.fault(i)) ? 0 : -1), colors: ['error'] },
    ];
  }
  /** Not armed yet, or disarmed by command, is no fault. */
  private isFault(fault: number): boolean {
    return fault !== 0 && this.session.faults[fault]?.name !== 'not-armed';
  }

  // ---- panel

  private panel(world: SessionWorld, rows: HTMLElement[]): HTMLElement[] {
    const seconds = world.time[world.frames - 1]! - world.time[0]!;
    const each = world.ticksPerFrame > 1 ? ` Each moment shown is ${world.ticksPerFrame} ticks; the largest force, slip and faults of them are kept.` : '';
    const key = (color: string, text: string): HTMLElement => h(`span.key.${color}`, {}, text);
    const legend = h('p.note.legend-line', {}, 'Lanes, from above: ', ...STATES.map((state) => key(state, state)), key('force', 'slip'), key('god', 'armed'), key('warning', 'ramping or fading'), key('error', 'fault'));
    const head = h('tr', {}, ...['Device', 'Gate', 'Contact', 'Force', 'Sent'].map((text) => h('th', { scope: 'col' }, text)));
    const events = this.events(world);
    const items = events.slice(0, MOST_EVENTS).map((event) => h('li', {}, button(`${world.time[event.at]!.toFixed(3)} s · ${event.text}`, () => this.shown?.timeline.seek(event.at), { className: event.isFault ? 'finding fault' : 'finding' })));
    const left = events.length - items.length;
    return [
      h('p.note', {}, `${grouped(this.session.objects.length)} object${this.session.objects.length === 1 ? '' : 's'}, ${world.devices.length} device${world.devices.length === 1 ? '' : 's'}, ${short(seconds)} s.${each}`),
      h('h2', {}, 'Now'),
      h('table.devices', { id: 'readout' }, h('thead', {}, head), h('tbody', {}, ...rows)),
      legend,
      h('h2', {}, 'Gate and faults'),
      h('ol.events', { id: 'events' }, ...items),
      ...(left > 0 ? [h('p.note', {}, `${grouped(left)} more are not listed.`)] : []),
    ];
  }

  private events(world: SessionWorld): Event[] {
    const events: Event[] = [];
    for (const device of world.devices) {
      for (let i = 0; i < world.frames; ++i) {
        const phase = device.phase(i);
        const fault = device.fault(i);
        const before = i === 0 ? { phase: -1, fault: 0 } : { phase: device.phase(i - 1), fault: device.fault(i - 1) };
        if (phase === before.phase && fault === before.fault) continue;
        const why = fault === 0 || fault === before.fault ? '' : `: ${this.session.faults[fault]?.text ?? fault}`;
        events.push({ at: i, text: `${device.name} ${PHASES[phase]}${why}`, isFault: why !== '' && this.isFault(fault) });
      }
    }
    return events.sort((a, b) => a.at - b.at);
  }

  private show(at: number): string {
    const { shown } = this;
    if (shown === undefined) return '';
    const { world, scene, rows } = shown;
    scene.show(at);
    const lines = world.devices.map((device, d) => {
      const state = STATES[device.state(at)]!;
      const felt = state === 'free' ? 'free' : `${state}, ${device.slips(at) ? 'slips' : 'sticks'}`;
      const force = Math.hypot(...device.wanted(at));
      const cells = [device.name, PHASES[device.phase(at)]!, felt, `${short(force)} N`, `${short(Math.hypot(...device.sent(at)))} N`];
      replaceChildren(rows[d]!, h('th', { scope: 'row' }, cells[0]!), ...cells.slice(1).map((text) => h('td', {}, text)));
      return `${cells[0]} ${cells.slice(1, 4).join(', ')}`;
    });
    this.chart?.mark(world.time[at]!);
    return `${world.time[at]!.toFixed(3)} s: ${lines.join('; ')}`;
  }

  private drawChart(): void {
    const { shown } = this;
    if (shown === undefined || !this.isActive) return;
    const { world, timeline, lanes } = shown;
    const series = world.devices.map((device, d) => ({ label: device.name, color: SERIES[d % SERIES.length]!, unit: 'N' }));
    this.chart ??= new Chart(timeline.element.querySelector('#chart-session')!, series, 110, (t) => timeline.seekTime(t));
    const stride = Math.max(1, Math.ceil(world.frames / MOST_POINTS));
    const count = Math.ceil(world.frames / stride);
    const highest = (device: SessionDevice, from: number): number => {
      let most = 0;
      for (let i = from; i < Math.min(from + stride, world.frames); ++i) most = Math.max(most, device.peak(i));
      return most;
    };
    this.chart.set(
      Float64Array.from({ length: count }, (_, k) => world.time[k * stride]!),
      ...world.devices.map((device) => Float64Array.from({ length: count }, (_, k) => highest(device, k * stride))),
    );
    this.chart.mark(timeline.t);
    for (const one of lanes) one.draw();
  }

  // ---- tab

  activate(): void {
    this.isActive = true;
    const { shown } = this;
    if (shown === undefined) return;
    shown.scene.visible = true;
    this.context.stage.animations.add(shown.timeline.animate);
    this.context.dock(shown.timeline.element);
    requestAnimationFrame(() => this.drawChart());
    shown.timeline.seek(shown.timeline.at);
  }
  deactivate(): void {
    this.isActive = false;
    const { shown } = this;
    if (shown === undefined) return;
    shown.timeline.setPlaying(false);
    shown.scene.visible = false;
    this.context.stage.animations.delete(shown.timeline.animate);
    this.context.dock(null);
  }
  key(event: KeyboardEvent): boolean {
    return this.shown?.timeline.key(event) ?? false;
  }
  applyTheme(): void {
    this.shown?.scene.applyTheme();
    if (this.chart !== undefined) this.drawChart();
  }
  times(): Float64Array {
    return this.shown?.world.time ?? new Float64Array();
  }
  state(): Record<string, unknown> {
    const { shown } = this;
    if (shown === undefined) return { ticks: 0 };
    const { world, scene, timeline, index } = shown;
    const { at } = timeline;
    return {
      ticks: world.frames,
      at,
      t: timeline.t,
      playing: timeline.isPlaying,
      world: index,
      same: this.session.same,
      devices: world.devices.map((device) => ({
        name: device.name,
        phase: PHASES[device.phase(at)],
        fault: this.session.faults[device.fault(at)]?.name,
        state: STATES[device.state(at)],
        slips: device.slips(at),
        force: device.wanted(at),
        contacts: device.pads.map((_, k) => device.contact(at, k)),
      })),
      objects: this.session.objects.map((object, i) => ({ name: object.name, ...scene.where(i) })),
    };
  }
}
