// SPDX-License-Identifier: Apache-2.0
// What the parts of the viewer share.
import type { Page } from './data';
import type { Stage } from './stage';

export interface Context {
  stage: Stage;
  page: Page;
  wasm: Uint8Array<ArrayBuffer>;
  /** Reads it out to those who hear the page. */
  announce(text: string): void;
  /** A line over the stage; empty takes it away. */
  hint(text: string): void;
  /** The place under the stage for traces and time lines; null takes it away. */
  dock(content: HTMLElement | null): void;
}

/** A tab of the panel, and what it shows on the stage. */
export interface Tab {
  readonly id: string;
  readonly title: string;
  readonly element: HTMLElement;
  activate(): void;
  deactivate(): void;
  /** True: the key was for this tab. */
  key(event: KeyboardEvent): boolean;
  applyTheme(): void;
  /** Of a log: the moments of its time line, seconds. */
  times?(): Float64Array;
  /** What the tests look at. */
  state(): Record<string, unknown>;
}
