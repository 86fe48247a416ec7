// SPDX-License-Identifier: Apache-2.0
// Charts over time, by uPlot, in the page's colours.
import uPlot from 'uplot';
import { cssColor } from './theme';

export interface Series {
  label: string;
  color: string; // custom property
  unit: string;
}

export class Chart {
  private readonly plot: uPlot;
  constructor(
    readonly holder: HTMLElement,
    private readonly series: readonly Series[],
    height: number,
    onSeek?: (t: number) => void,
  ) {
    const axis = { stroke: () => cssColor('quiet'), grid: { stroke: () => cssColor('line'), width: 1 }, ticks: { show: false }, font: '11px system-ui, sans-serif' };
    this.plot = new uPlot(
      {
        width: 300,
        height,
        legend: { show: false },
        cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
        scales: { x: { time: false } },
        axes: [{ ...axis, size: 22, values: (_, ticks) => ticks.map((t) => `${Number(t.toFixed(3))} s`) }, { ...axis, size: 48 }],
        series: [{}, ...series.map((one) => ({ label: one.label, stroke: () => cssColor(one.color), width: 1.25, points: { show: false } }))],
      },
      [[], ...series.map(() => [])],
      holder,
    );
    new ResizeObserver(() => this.fit(height)).observe(holder);
    if (onSeek !== undefined) {
      const seek = (event: MouseEvent): void => {
        if (event.buttons === 1) onSeek(this.plot.posToVal(event.clientX - this.plot.over.getBoundingClientRect().left, 'x'));
      };
      this.plot.over.addEventListener('mousedown', seek);
      this.plot.over.addEventListener('mousemove', seek);
    }
  }
  private fit(height: number): void {
    if (this.holder.clientWidth > 0) this.plot.setSize({ width: this.holder.clientWidth, height });
  }
  set(x: Float64Array, ...values: Float64Array[]): void {
    this.plot.setData([x, ...values.slice(0, this.series.length)] as uPlot.AlignedData);
  }
  /** A line at this time; none where it is undefined. */
  mark(t: number | undefined): void {
    this.plot.setCursor({ left: t === undefined ? -10 : this.plot.valToPos(t, 'x'), top: 0 });
  }
}
