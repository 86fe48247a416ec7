// SPDX-License-Identifier: Apache-2.0
// A recording of touch: what it is saved as, and which command makes the same of it.
import { button, download, h } from './dom';
import type { Frame } from './frame';
import { short } from './numbers';
import { EFFECTS, type EffectKind, type Runtime, type TouchParams } from './runtime';
import { logCsv, pathCsv } from './touch_csv';
import { HIP, TICK, TICK_S } from './touch_messages';

export interface TouchSource {
  frame: Frame;
  runtime: Runtime; // of the page, for rays
  graph: Uint8Array<ArrayBuffer>;
  graphName: string; // for the command that replays
  compile?: string; // the command that makes the graph from the mesh; undefined: it is a file of its own
}

/** As a shell takes it. */
export function quoted(name: string): string {
  return /^[\w.+-]+$/.test(name) && !name.startsWith('-') ? name : `'./${name.replaceAll("'", "'\\''")}'`;
}

function quotedText(text: string): string {
  return /^[\w.+,=-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** What replays the recording natively, to the same bytes. */
function replayCommand(source: TouchSource, p: TouchParams): string {
  const options = [`--mu-s ${p.muStatic} --mu-d ${p.muDynamic} --stiffness ${p.stiffness}`];
  if (p.damping > 0) options.push(`--damping ${p.damping}`);
  for (const [term, value] of Object.entries(p.curve)) options.push(`--${term} ${value}`);
  const names = source.runtime.materials();
  p.materials?.forEach((m, i) => options.push(`--material ${quotedText(`${names[i]}=${m.muStatic},${m.muDynamic},${m.stiffness}`)}`));
  if (p.shading) options.push('--shading');
  if (p.relief.kind !== 'none') options.push(`--relief ${p.relief.kind === 'image' ? 'image' : `${p.relief.kind}=${p.relief.numbers.join(',')}`}`);
  for (const kind of Object.keys(EFFECTS) as EffectKind[]) {
    const numbers = p.effects[kind];
    if (numbers !== undefined) options.push(`--effect ${[kind, ...EFFECTS[kind].map((key, i) => `${key}=${numbers[i]}`)].join(',')}`);
  }
  return `fdcg-servo replay ${quoted(source.graphName)} --trajectory hip.csv -o log.csv ${options.join(' ')}`;
}

/** Nanoseconds a step, over the recorded path. */
export function timeRecording(source: TouchSource, ticks: Float64Array, params: TouchParams): number {
  const hips = Float64Array.from({ length: (3 * ticks.length) / TICK }, (_, i) => ticks[Math.floor(i / 3) * TICK + HIP + (i % 3)]!);
  return source.runtime.timeSteps(hips, params);
}

export function recordingPanel(source: TouchSource, ticks: Float64Array, params: TouchParams, stepNs: number): HTMLElement[] {
  const count = ticks.length / TICK;
  const panel = [
    h('p', {}, `${(count * TICK_S).toFixed(2)} s, ${count} ticks. Without the clock a step takes ${short(stepNs)} ns on this path.`),
    h(
      'div.row',
      {},
      button('Path (CSV)', () => download('hip.csv', pathCsv(ticks)), { id: 'save-path' }),
      button('Log (CSV)', () => download('page-log.csv', logCsv(ticks)), { id: 'save-log' }),
      button('Graph', () => download(source.graphName, source.runtime.bytes().slice()), { id: 'save-graph' }),
    ),
    h('p.note', {}, 'This writes the same log, byte for byte:'),
    h('pre.records', { tabIndex: 0, id: 'replay-command' }, replayCommand(source, params)),
  ];
  if (source.compile !== undefined) panel.push(h('p.note', {}, `The graph is also what this makes: ${source.compile}`));
  return panel;
}
