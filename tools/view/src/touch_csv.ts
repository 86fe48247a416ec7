// SPDX-License-Identifier: Apache-2.0
// A recording as files: the path of the hand for fdcg-servo replay, and the log that this replay writes, byte for byte.
import { precise } from './numbers';
import { NONE, STATES } from './runtime';
import { FEATURE, HIP, SLIP, STATE, TICK, TRANSITIONS } from './touch_messages';

export const LOG_HEADER = 't,hip_x,hip_y,hip_z,go_x,go_y,go_z,fx,fy,fz,state,feature,slip,transitions';

function rows(ticks: Float64Array, row: (at: number) => string): string {
  const lines: string[] = [];
  for (let at = 0; at < ticks.length; at += TICK) lines.push(row(at));
  return `${lines.join('\n')}\n`;
}

export function pathCsv(ticks: Float64Array): string {
  return `t,x,y,z\n${rows(ticks, (at) => [0, HIP, HIP + 1, HIP + 2].map((k) => precise(ticks[at + k]!)).join(','))}`;
}

export function logCsv(ticks: Float64Array): string {
  return `${LOG_HEADER}\n${rows(ticks, (at) => {
    const numbers = Array.from({ length: 10 }, (_, k) => precise(ticks[at + k]!));
    const feature = ticks[at + FEATURE]!;
    return [...numbers, STATES[ticks[at + STATE]!], feature === NONE ? '-1' : feature, ticks[at + SLIP], ticks[at + TRANSITIONS]].join(',');
  })}`;
}

/** Reads a log again, into ticks. Throws where it is none. */
export function parseLog(text: string): Float64Array {
  const lines = text.split('\n');
  if (lines[0]?.trim() !== LOG_HEADER) throw new Error('this is no log of fdcg-servo replay');
  if (lines.at(-1) === '') lines.pop();
  const ticks = new Float64Array((lines.length - 1) * TICK);
  for (let i = 1; i < lines.length; ++i) {
    const fields = lines[i]!.split(',');
    const at = (i - 1) * TICK;
    for (let k = 0; k < TICK; ++k) ticks[at + k] = Number(fields[k]);
    ticks[at + STATE] = Math.max(0, STATES.indexOf(fields[STATE] as (typeof STATES)[number]));
    if (fields[FEATURE] === '-1') ticks[at + FEATURE] = NONE;
  }
  return ticks;
}
