// SPDX-License-Identifier: Apache-2.0
// path_hash.c in JavaScript, by the npm package. Arguments: folder of the package, the cube's graph.
import { readFile } from 'node:fs/promises';
import { pathToFileURL } from 'node:url';

const [folder, graph] = process.argv.slice(2);
const { Contact } = await import(pathToFileURL(`${folder}/index.js`));
const hips = new Float64Array(60000);
for (let i = 0; i < 20000; ++i) {
  hips[3 * i] = (((i * 7) % 1200) / 1200) * 1.2 - 0.1;
  hips[3 * i + 1] = (i % 977) / 977;
  hips[3 * i + 2] = i % 4000 === 0 ? 1.1 : 0.98 + (i % 101) / 10100;
}
const hashOf = (forces) => {
  let hash = 0xcbf29ce484222325n;
  for (const word of new BigUint64Array(forces.buffer)) hash = BigInt.asUintN(64, (hash ^ word) * 0x100000001b3n);
  return hash.toString(16).padStart(16, '0');
};

const contact = await Contact.open(await readFile(graph));
const forces = contact.path(hips);
contact.reset();
const single = new Float64Array(60000);
const begin = performance.now();
for (let i = 0; i < 20000; ++i) single.set(contact.step(hips[3 * i], hips[3 * i + 1], hips[3 * i + 2]).force, 3 * i);
if (hashOf(single) !== hashOf(forces)) throw new Error('single steps differ from the path');
const refused = async (run, words) => {
  try {
    await run();
  } catch (error) {
    if (error.message.includes(words)) return;
    throw error;
  }
  throw new Error(`not refused: ${words}`);
};
await refused(() => Contact.open(new Uint8Array(300)), 'FDCG');
await refused(() => contact.setParams({ muStatic: 0.1, muDynamic: 0.2 }), 'mu_static');
await refused(() => contact.path([1, 2]), 'three a tick');
console.log(hashOf(forces));
