// SPDX-License-Identifier: Apache-2.0
// node bundle.mjs FDCG.wasm OUTPUT.html: the viewer as one page without data. The same sources give the same bytes.
import { createHash } from 'node:crypto';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';
import { build } from 'esbuild';

const [wasm, output] = process.argv.slice(2);

async function bundled(entry, plugins = []) {
  const result = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: 'iife',
    target: ['chrome110', 'firefox115', 'safari16'],
    legalComments: 'none', // licences() has them in full
    charset: 'ascii',
    write: false,
    plugins,
    loader: { '.css': 'text' },
  });
  return result.outputFiles[0].text.trim();
}

// `import source from 'worker:./x.ts'`: the bundle of another entry, as a string.
const workers = {
  name: 'workers',
  setup(builder) {
    builder.onResolve({ filter: /^worker:/ }, (found) => ({ path: found.path.slice('worker:'.length), namespace: 'worker' }));
    builder.onLoad({ filter: /.*/, namespace: 'worker' }, async (found) => ({
      contents: await bundled(found.path),
      loader: 'text',
    }));
  },
};

function licences() {
  const from = [
    ['three.js', 'node_modules/three/LICENSE'],
    ['uPlot', 'node_modules/uplot/LICENSE'],
    ['wasi-libc', '/usr/share/doc/wasi-libc/copyright'],
  ];
  return from
    .filter(([, path]) => existsSync(path))
    .map(([name, path]) => `${name}\n\n${readFileSync(path, 'utf8').trim()}\n`)
    .join(`\n${'-'.repeat(72)}\n\n`);
}

const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
const packed = (bytes) => deflateSync(bytes, { level: 9 }).toString('base64');

const script = await bundled('src/main.ts', [workers]);
const style = readFileSync('src/style.css', 'utf8') + readFileSync('node_modules/uplot/dist/uPlot.min.css', 'utf8');
const policy = [
  "default-src 'none'",
  `script-src ${hash(script)} 'wasm-unsafe-eval' blob:`,
  'worker-src blob:',
  `style-src ${hash(style)}`,
  'img-src data: blob:',
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

const page = readFileSync('src/page.html', 'utf8');
const filled = page.replace(/\{\{(\w+)\}\}/g, (_, name) => ({
  policy,
  style,
  script,
  wasm: packed(readFileSync(wasm)),
  licences: packed(Buffer.from(licences())),
})[name]);
writeFileSync(output, filled);
