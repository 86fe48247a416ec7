// SPDX-License-Identifier: Apache-2.0
// The last two seconds of touch as charts: normal and tangential force, and their ratio.
import { h } from './dom';
import { FORCE, T, TICK, TICK_S } from './touch_messages';
import { Chart } from './traces';

const SHOWN_TICKS = 2000;

export class TouchTraces {
  readonly element = h(
    'div.charts',
    {},
    h('div.chart', { id: 'chart-force' }, h('p.chart-title', {}, 'Force in newtons: ', h('span.key.force', {}, 'normal'), ' and ', h('span.key.edge', {}, 'tangential'))),
    h('div.chart', { id: 'chart-ratio' }, h('p.chart-title', {}, h('span.key.vertex', {}, 'Tangential over normal force'))),
  );
  count = 0;
  private readonly t = new Float64Array(SHOWN_TICKS);
  private readonly normal = new Float64Array(SHOWN_TICKS);
  private readonly tangential = new Float64Array(SHOWN_TICKS);
  private readonly ratios = new Float64Array(SHOWN_TICKS);
  private charts: { force: Chart; ratio: Chart } | undefined;

  add(ticks: Float64Array, normals: Float64Array): void {
    for (let at = 0, n = 0; at < ticks.length; at += TICK, n += 3) {
      const force = [0, 1, 2].map((k) => ticks[at + FORCE + k]!);
      const along = force.reduce((sum, f, k) => sum + f * normals[n + k]!, 0);
      const size = Math.hypot(...force);
      const i = this.count++ % SHOWN_TICKS;
      this.t[i] = ticks[at + T]!;
      this.normal[i] = normals[n] === 0 && normals[n + 1] === 0 && normals[n + 2] === 0 ? size : along;
      this.tangential[i] = Math.sqrt(Math.max(0, size * size - this.normal[i]! ** 2));
      this.ratios[i] = this.normal[i]! > 1e-12 ? this.tangential[i]! / this.normal[i]! : 0;
    }
  }

  /** Of the last tick. */
  get ratio(): number {
    return this.count === 0 ? 0 : this.ratios[(this.count - 1) % SHOWN_TICKS]!;
  }

  begin(): void {
    this.charts ??= {
      force: new Chart(this.element.querySelector('#chart-force')!, [{ label: 'normal', color: 'force', unit: 'N' }, { label: 'tangential', color: 'edge', unit: 'N' }], 120),
      ratio: new Chart(this.element.querySelector('#chart-ratio')!, [{ label: 'ratio', color: 'vertex', unit: '' }], 120),
    };
  }

  draw(): void {
    const count = Math.min(this.count, SHOWN_TICKS);
    if (count === 0) return;
    const from = this.count % SHOWN_TICKS;
    const inOrder = (values: Float64Array): Float64Array => {
      if (this.count <= SHOWN_TICKS) return values.slice(0, count);
      const sorted = new Float64Array(count);
      sorted.set(values.subarray(from));
      sorted.set(values.subarray(0, from), SHOWN_TICKS - from);
      return sorted;
    };
    const newest = this.t[(this.count - 1) % SHOWN_TICKS]!;
    const t = Float64Array.from({ length: count }, (_, i) => newest - (count - 1 - i) * TICK_S);
    this.charts?.force.set(t, inOrder(this.normal), inOrder(this.tangential));
    this.charts?.ratio.set(t, inOrder(this.ratios));
  }
}
