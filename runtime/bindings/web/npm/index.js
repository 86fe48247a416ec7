// SPDX-License-Identifier: Apache-2.0
// The runtime in JavaScript: one module, one graph and one contact each (runtime/bindings/web/fdcg_web.c). Forces have the bits of
// every other platform.

const STATES = ['free', 'face', 'edge', 'vertex'];
const RESULT_BYTES = 72;

/** What fdcg.wasm holds, beside this file: read by Node.js, fetched by browsers. */
async function ownModule() {
  const place = new URL('./fdcg.wasm', import.meta.url);
  if (place.protocol !== 'file:') return (await fetch(place)).arrayBuffer();
  const { readFile } = await import('node:fs/promises');
  return readFile(place);
}

export class Contact {
  #x;
  #graph = 0;

  /** @param instance of fdcg.wasm; use open() */
  constructor(instance) {
    this.#x = instance.exports;
  }

  /** Verifies a .fdcg file's bytes. Throws an Error with the library's words. */
  static async open(bytes, params = {}, wasm = undefined) {
    const { instance } = await WebAssembly.instantiate(wasm ?? (await ownModule()));
    const contact = new Contact(instance);
    contact.#read(bytes);
    contact.setParams(params);
    return contact;
  }

  #read(bytes) {
    const data = bytes instanceof ArrayBuffer ? new Uint8Array(bytes) : new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.#graph = this.#allocate(data.length);
    new Uint8Array(this.#x.memory.buffer).set(data, this.#graph);
    this.#check(this.#x.fdcg_web_open(this.#graph, data.length));
  }
  #allocate(bytes) {
    const room = this.#x.fdcg_web_allocate(bytes);
    if (room === 0) throw new Error(`fdcg: no memory for ${bytes} bytes`);
    return room;
  }
  #check(status) {
    if (status === 0) return;
    const from = this.#x.fdcg_web_message();
    const memory = new Uint8Array(this.#x.memory.buffer);
    throw new Error(new TextDecoder().decode(memory.subarray(from, memory.indexOf(0, from))));
  }

  /** Newtons, metres, seconds; what is left out has its default. */
  setParams({ muStatic = 0.6, muDynamic = 0.4, stiffness = 1000, damping = 0 } = {}) {
    this.#check(this.#x.fdcg_web_set_params(muStatic, muDynamic, stiffness, damping, 0, 0));
  }

  /** The contact is that of a hand that has touched nothing yet. */
  reset() {
    this.#x.fdcg_web_reset();
  }

  /** A tick: moves the HIP, metres in the object's frame. */
  step(x, y, z) {
    new Float64Array(this.#x.memory.buffer, this.#x.fdcg_web_hip(), 3).set([x, y, z]);
    this.#x.fdcg_web_step();
    const at = this.#x.fdcg_web_result();
    const numbers = new Float64Array(this.#x.memory.buffer, at, 6), words = new Uint32Array(this.#x.memory.buffer, at + 48, 5);
    return {
      force: [numbers[0], numbers[1], numbers[2]],
      godObject: [numbers[3], numbers[4], numbers[5]],
      state: STATES[words[0]],
      feature: words[1],
      isSlipping: words[2] !== 0,
      flags: words[4],
    };
  }

  /** A tick for each three numbers of `hips`; the forces, three a tick. */
  path(hips) {
    const count = hips.length / 3;
    if (!Number.isInteger(count)) throw new Error(`fdcg: a path of ${hips.length} numbers; it needs three a tick`);
    const forces = new Float64Array(3 * count);
    const room = this.#allocate(count * (24 + RESULT_BYTES) + 8), results = room + 24 * count;
    new Float64Array(this.#x.memory.buffer, room, 3 * count).set(hips);
    this.#x.fdcg_web_run(room, results, count);
    const felt = new Float64Array(this.#x.memory.buffer, results, (RESULT_BYTES / 8) * count);
    for (let i = 0; i < count; ++i) forces.set(felt.subarray(9 * i, 9 * i + 3), 3 * i);
    this.#x.fdcg_web_release(room);
    return forces;
  }
}
