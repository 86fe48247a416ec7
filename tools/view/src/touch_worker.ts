// SPDX-License-Identifier: Apache-2.0
// The loop at 1 kHz, in a Worker: the HIP follows the page's target smoothly, each tick is one fdcg_step. Ticks are made by the
// clock: where the system comes late, the missing ones are made up for at once, so that time in the simulation is real.
import { type Result, Runtime, type TouchParams } from './runtime';
import { type FromWorker, TICK, TICK_S, type ToWorker } from './touch_messages';

const FOLLOW = 0.06; // of the way to the target in a tick: a time constant of 16 ms
const MOST_LATE_MS = 100; // what is longer than this is a pause, not lateness
const REPORT_TICKS = 16;
const MOST_RECORDED = 600_000; // ten minutes
const PERIODS = 4096;
const STEPS_MEASURED = 8192;

let runtime: Runtime | undefined;
let running = false;
let hip: [number, number, number] | undefined;
let target: [number, number, number] | undefined;
let isShaded = false;
let mostSpeed = 0; // of the HIP, metres a second; 0: as the target asks
let tick = 0;
let dueMs = 0;
let lastMs = 0;
let result: Result | undefined;
let recording: 'no' | 'wanted' | 'on' = 'no';
let recorded: number[] = [];
let batch: number[] = [];
let normals: number[] = [];
let stepMs = 0; // of stepCount steps: the clock is coarse, and right on the average only
let stepCount = 0;
const periods = new Float64Array(PERIODS);
let periodCount = 0;

function say(message: FromWorker, transfer: Transferable[] = []): void {
  (self as unknown as Worker).postMessage(message, transfer);
}

// A place in shared memory to sleep on. Where there is none the loop spins.
const sleeper = ((): Int32Array | undefined => {
  try {
    return new Int32Array(new WebAssembly.Memory({ initial: 1, maximum: 1, shared: true }).buffer);
  } catch {
    return undefined;
  }
})();

/** Along which the friction cone stands; zeros: there is none. */
function coneNormal(from: Runtime, r: Result): readonly number[] {
  if (r.state !== 1) return [0, 0, 0];
  return isShaded ? from.shadedNormal(r.feature, r.godObject) : from.node(r.feature).normal;
}

function makeTick(now: number): void {
  if (runtime === undefined || target === undefined) return;
  hip ??= [...target];
  const way = target.map((x, k) => (x - hip![k]!) * FOLLOW);
  const most = mostSpeed > 0 ? Math.min(1, (mostSpeed * TICK_S) / Math.hypot(...way)) : 1;
  for (let k = 0; k < 3; ++k) hip[k] = hip[k]! + way[k]! * most;
  if (recording === 'wanted' && (result === undefined || result.state === 0)) {
    runtime.reset(); // what replays natively begins with a contact that has touched nothing
    recording = 'on';
    recorded = [];
    tick = 0;
  }
  const before = performance.now();
  result = runtime.step(hip);
  stepMs += performance.now() - before;
  if (++stepCount === STEPS_MEASURED) {
    stepMs /= 2;
    stepCount /= 2;
  }
  const r = result;
  const row = [tick * TICK_S, ...hip, ...r.godObject, ...r.force, r.state, r.feature, r.slipping, r.transitions];
  batch.push(...row);
  normals.push(...coneNormal(runtime, r));
  if (recording === 'on' && recorded.length < MOST_RECORDED * TICK) recorded.push(...row);
  ++tick;
  if (lastMs > 0) periods[periodCount++ % PERIODS] = now - lastMs;
  lastMs = now;
}

function report(): void {
  const known = periods.slice(0, Math.min(periodCount, PERIODS)).sort();
  const ticks = Float64Array.from(batch);
  const n = Float64Array.from(normals);
  say({ kind: 'ticks', ticks, normals: n, timing: { stepNs: (stepMs / stepCount) * 1e6, periodP99Ms: known[Math.floor(known.length * 0.99)] ?? 0 } }, [ticks.buffer, n.buffer]);
  if (recording === 'on') say({ kind: 'recording', seconds: tick * TICK_S });
  batch = [];
  normals = [];
}

const channel = new MessageChannel();
channel.port1.onmessage = () => {
  if (!running) return;
  let now = performance.now();
  if (now - dueMs > MOST_LATE_MS) dueMs = now;
  while (dueMs <= now) {
    makeTick(now);
    dueMs += TICK_S * 1000;
    if (batch.length >= REPORT_TICKS * TICK) report();
  }
  now = performance.now();
  if (sleeper !== undefined && dueMs - now > 0.15) Atomics.wait(sleeper, 0, 0, dueMs - now - 0.1);
  channel.port2.postMessage(null);
};

function setRunning(on: boolean): void {
  if (on === running) return;
  running = on;
  lastMs = 0;
  if (!on) return;
  dueMs = performance.now();
  channel.port2.postMessage(null);
}

function stopRecording(): void {
  const was = recording;
  recording = 'no';
  if (was !== 'on') return;
  const ticks = Float64Array.from(recorded);
  recorded = [];
  say({ kind: 'recorded', ticks }, [ticks.buffer]);
}

function setParams(params: TouchParams): void {
  runtime?.setParams(params);
  isShaded = params.shading && runtime?.hasNormals === true;
}

async function open(message: Extract<ToWorker, { kind: 'open' }>): Promise<void> {
  const made = await Runtime.make(message.wasm);
  made.open(message.graph);
  runtime = made;
  setParams(message.params);
  say({ kind: 'opened' });
}

self.onmessage = (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  if (message.kind === 'open') open(message).catch((error: unknown) => say({ kind: 'failed', message: String(error) }));
  else if (message.kind === 'run') setRunning(message.on);
  else if (message.kind === 'params') setParams(message.params);
  else if (message.kind === 'hand') mostSpeed = message.metresPerS;
  else if (message.kind === 'record') {
    if (message.on) recording = 'wanted';
    else stopRecording();
  } else {
    target = message.hip;
    if (message.jump && recording === 'no') {
      hip = [...target];
      runtime?.reset();
    }
  }
};
