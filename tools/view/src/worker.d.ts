// SPDX-License-Identifier: Apache-2.0
// `worker:FILE` is the bundle of FILE as text (bundle.mjs).
declare module 'worker:*' {
  const source: string;
  export default source;
}
