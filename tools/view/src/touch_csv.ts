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

/** Reads a log again, into ticks; of a session's log, which has more columns, the rows of its first device. Throws where it is
 * none. */
export function parseLog(text: string): Float64Array {
  const lines = text.split('\n').map((line) => line.trim());
  if (!(lines[0] ?? '').startsWith(LOG_HEADER)) throw new Error('this is no log of fdcg-servo replay');
  const device = lines[0]!.split(',').indexOf('device');
  const rows = lines.slice(1).filter((line) => line !== '').map((line) => line.split(','));
  const kept = device < 0 ? rows : rows.filter((fields) => fields[device] === rows[0]![device]);
  const ticks = new Float64Array(kept.length * TICK);
  kept.forEach((fields, i) => {
    for (let k = 0; k < TICK; ++k) ticks[i * TICK + k] = Number(fields[k]);
    ticks[i * TICK + STATE] = Math.max(0, STATES.indexOf(fields[STATE] as (typeof STATES)[number]));
    if (fields[FEATURE] === '-1') ticks[i * TICK + FEATURE] = NONE;
  });
  if (kept.length === 0) throw new Error('the log has no tick');
  return ticks;
}
