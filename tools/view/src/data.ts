// SPDX-License-Identifier: Apache-2.0
// What the native program has put into the page: arrays as base64 of deflated, filtered bytes (tools/page/packed_array.hpp), and
// items as JSON, compressed as well.
import type { SessionRef } from './session_data';

export interface ArrayRef {
  bytes: number;
  runs: [number, number][];
  blob: number;
}

export interface Element3 {
  faces?: number[];
  more_faces?: number;
  edges?: [number, number][];
  vertices?: number[];
  point?: [number, number, number] | null;
  line?: number;
  part?: string;
}

export type Severity = 'error' | 'warning' | 'note';

export interface Issue {
  rule: string;
  severity: Severity;
  total: number;
  message: string;
  elements: Element3[];
}

export interface Report {
  file: string;
  verdict: 'pass' | 'fail';
  vertices: number;
  faces: number;
  components: number;
  issues: Issue[];
}

export interface Geometry {
  centre: [number, number, number];
  size: number;
  points: ArrayRef;
  corners: ArrayRef;
  sizes?: ArrayRef;
  face_lines?: ArrayRef;
  point_lines?: ArrayRef;
  face_materials?: ArrayRef;
}

export interface RepairAction {
  name: string;
  total: number;
  message: string;
  left: { total: number; message: string };
}

export interface Item {
  name: string;
  report?: Report;
  geometry?: Geometry;
  parts?: [string, number][];
  materials?: string[];
  graph?: ArrayRef;
  no_graph?: string;
  compile_options?: string;
  repaired?: { geometry: Geometry; report: Report; account: { actions?: RepairAction[] } | null };
  log?: ArrayRef & { name: string };
  session?: SessionRef;
}

export interface Rule {
  name: string;
  meaning: string;
  why: string;
  remedy: string;
}

export interface Page {
  version: string;
  title: string;
  rules: Rule[];
}

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> }).fromBase64;
  if (native !== undefined) return native.call(Uint8Array, text); // not in every browser yet, and much faster
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(text: string): Promise<Uint8Array<ArrayBuffer>> {
  const stream = new Blob([fromBase64(text)]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const LITTLE_ENDIAN = new Uint8Array(Uint32Array.of(1).buffer)[0] === 1;

/** Undoes the filter of one run of records. */
function unfilter(from: Uint8Array, at: number, bytes: number, stride: number, to: Uint8Array): void {
  const records = stride === 0 ? 0 : Math.floor(bytes / stride);
  const size = stride / 4;
  const isAligned = (to.byteOffset + at) % 4 === 0 && LITTLE_ENDIAN;
  const words = isAligned ? new Uint32Array(to.buffer, to.byteOffset + at, records * size) : undefined;
  const view = new DataView(to.buffer, to.byteOffset);
  for (let w = 0; w < (records === 0 ? 0 : size); ++w) {
    const a = at + 4 * w * records;
    const [b, c, d] = [a + records, a + 2 * records, a + 3 * records];
    let before = 0;
    for (let r = 0; r < records; ++r) {
      const zigzag = from[a + r]! | (from[b + r]! << 8) | (from[c + r]! << 16) | (from[d + r]! << 24);
      before = (before + ((zigzag >>> 1) ^ -(zigzag & 1))) | 0;
      if (words !== undefined) words[r * size + w] = before;
      else view.setInt32(at + r * stride + 4 * w, before, true);
    }
  }
  const done = records * stride;
  to.set(from.subarray(at + done, at + bytes), at + done);
}

function textOf(id: string): string {
  return document.getElementById(id)?.textContent ?? '';
}

/** Reads an array of the page. Its text leaves the document, so that memory holds it once. */
export async function readArray(ref: ArrayRef): Promise<Uint8Array<ArrayBuffer>> {
  const filtered = await inflated(textOf(`blob-${ref.blob}`));
  if (ref.runs.length === 0) return filtered;
  const bytes = new Uint8Array(ref.bytes);
  let at = 0;
  for (const [length, stride] of ref.runs) {
    unfilter(filtered, at, length, stride, bytes);
    at += length;
  }
  bytes.set(filtered.subarray(at), at);
  return bytes;
}

async function readText(element: Node): Promise<string> {
  return new TextDecoder().decode(await inflated(element.textContent ?? ''));
}

export async function readPage(): Promise<Page> {
  return JSON.parse(await readText(document.getElementById('page')!)) as Page;
}

export function itemCount(): number {
  return document.querySelectorAll('script.item').length;
}

export async function readItem(index: number): Promise<Item> {
  return JSON.parse(await readText(document.querySelectorAll('script.item')[index]!)) as Item;
}

export async function readLicences(): Promise<string> {
  return readText(document.getElementById('licences')!);
}

export async function readWasm(): Promise<Uint8Array<ArrayBuffer>> {
  return inflated(textOf('wasm'));
}
