// SPDX-License-Identifier: Apache-2.0
// Lanes under a time line: what holds when, a stripe each, a column a pixel. What lasted a moment is still a pixel wide.
import { h } from './dom';
import { cssColor } from './theme';

export interface Lane {
  height: number; // pixels
  /** The place among the colours of what holds at i, or -1; of several in a pixel the largest is drawn. */
  level(i: number): number;
  colors: readonly string[]; // custom properties
}

const GAP = 3;
const NO_FRAME = -2; // a pixel between two frames: what held before holds

export class Lanes {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;
  private readonly height: number;
  constructor(
    private readonly time: Float64Array,
    private readonly lanes: readonly Lane[],
    name = '',
    onSeek?: (t: number) => void,
  ) {
    this.height = lanes.reduce((sum, lane) => sum + lane.height + GAP, 0);
    this.canvas = h('canvas.lane', { height: this.height, 'aria-hidden': 'true' });
    this.canvas.style.height = `${this.height}px`;
    this.element = h('div.lanes', {}, h('span.lane-name', { title: name }, name), this.canvas);
    if (onSeek === undefined) return;
    const seek = (event: PointerEvent): void => {
      if (event.buttons !== 1) return;
      const { left, width } = this.canvas.getBoundingClientRect();
      onSeek(this.from + ((event.clientX - left) / width) * (this.to - this.from));
    };
    this.canvas.addEventListener('pointerdown', seek);
    this.canvas.addEventListener('pointermove', seek);
  }
  private get from(): number {
    return this.time[0]!;
  }
  private get to(): number {
    return this.time[this.time.length - 1]!;
  }

  draw(): void {
    const width = Math.max(1, this.canvas.clientWidth);
    this.canvas.width = width;
    this.canvas.height = this.height;
    const context = this.canvas.getContext('2d')!;
    let top = 0;
    for (const lane of this.lanes) {
      const levels = new Int8Array(width).fill(NO_FRAME);
      for (let i = 0; i < this.time.length; ++i) {
        const x = Math.min(width - 1, Math.floor(((this.time[i]! - this.from) / (this.to - this.from || 1)) * width));
        levels[x] = Math.max(levels[x]!, lane.level(i));
      }
      const colors = lane.colors.map(cssColor);
      let held = -1;
      for (let x = 0; x < width; ++x) {
        if (levels[x]! !== NO_FRAME) held = levels[x]!;
        if (held < 0) continue;
        context.fillStyle = colors[held]!;
        context.fillRect(x, top, 1, lane.height);
      }
      top += lane.height + GAP;
    }
  }
}
