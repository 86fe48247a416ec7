// SPDX-License-Identifier: Apache-2.0
// Colours: those of the page are in style.css, and the stage reads what it needs from there.
import { Color } from 'three';

export type Mode = 'dark' | 'light';

export function currentMode(): Mode {
  const chosen = document.documentElement.dataset['theme'];
  if (chosen === 'dark' || chosen === 'light') return chosen;
  return matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark';
}

export function toggleMode(): void {
  document.documentElement.dataset['theme'] = currentMode() === 'dark' ? 'light' : 'dark';
}

/** A custom property of the page as a colour. */
export function themeColor(name: string): Color {
  return new Color(getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim() || '#888888');
}

export function cssColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
