// SPDX-License-Identifier: Apache-2.0
// A time line: play and pause, speed, loop, a scrubber, and a place for what stands under it.
import { button, checkbox, h } from './dom';

const SPEEDS = [0.01, 0.1, 0.25, 1, 4];

export interface Played {
  /** Seconds, ascending. At least one. */
  time: Float64Array;
  /** Shows this moment; what it says is read out with the scrubber. */
  show(at: number): string;
  invalidate(): void;
}

export class Timeline {
  readonly element = h('div.timeline');
  at = 0;
  isPlaying = false;
  private readonly scrubber: HTMLInputElement;
  private readonly playButton = button('Play', () => this.setPlaying(!this.isPlaying), { id: 'play', title: 'Play or pause (Space)' });
  private speed = 1;
  private loops = false;
  private lastMs = 0;
  private exact = 0; // seconds

  constructor(
    private readonly played: Played,
    ...under: HTMLElement[]
  ) {
    this.scrubber = h('input', { type: 'range', id: 'scrub', min: '0', max: String(this.last), step: '1', value: '0', 'aria-label': 'Time', oninput: () => this.seek(Number(this.scrubber.value)) });
    const speed = h('select', { id: 'speed', 'aria-label': 'Speed', onchange: () => (this.speed = Number(speed.value)) });
    for (const value of SPEEDS) speed.append(h('option', { value: String(value), selected: value === 1 }, `${value} x`));
    this.element.append(h('div.row', {}, this.playButton, speed, checkbox('Loop', false, (on) => (this.loops = on), 'loop'), this.scrubber), ...under);
  }

  private get last(): number {
    return Math.max(0, this.played.time.length - 1);
  }
  get t(): number {
    return this.played.time[this.at]!;
  }

  setPlaying(on: boolean): void {
    this.isPlaying = on;
    this.playButton.textContent = on ? 'Pause' : 'Play';
    this.lastMs = performance.now();
    if (on && this.at >= this.last) this.seek(0);
    this.exact = this.t;
    this.played.invalidate();
  }

  /** For the stage: before each frame. */
  readonly animate = (now: number): boolean => {
    if (!this.isPlaying) return false;
    this.exact += (Math.max(0, now - this.lastMs) / 1000) * this.speed;
    this.lastMs = now;
    const { time } = this.played;
    let i = this.at;
    while (i < this.last && time[i + 1]! <= this.exact) ++i;
    if (i >= this.last) {
      if (this.loops) {
        i = 0;
        this.exact = time[0]!;
      } else this.setPlaying(false);
    }
    this.go(i);
    return this.isPlaying;
  };

  seek(i: number): void {
    this.go(Math.min(this.last, Math.max(0, i)));
    this.exact = this.t;
  }
  seekTime(t: number): void {
    const { time } = this.played;
    let low = 0;
    let high = this.last;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (time[middle]! < t) low = middle + 1;
      else high = middle;
    }
    this.seek(low);
  }
  private go(i: number): void {
    this.at = i;
    this.scrubber.value = String(i);
    this.scrubber.setAttribute('aria-valuetext', this.played.show(i));
  }

  key(event: KeyboardEvent): boolean {
    if (event.key === ' ') this.setPlaying(!this.isPlaying);
    else if (event.key === ',') this.seek(this.at - 1);
    else if (event.key === '.') this.seek(this.at + 1);
    else return false;
    return true;
  }
}
