// SPDX-License-Identifier: Apache-2.0
// Elements without markup: every text is a text node, so that nothing in a mesh can become an element or a script.

type Child = Node | string | null | undefined | false;
type Properties = Record<string, string | number | boolean | undefined | ((event: never) => void)>;

/** h('button.primary', {onclick, title}, 'Text'). Names with a dash, role and for are attributes, the rest are properties. */
export function h<K extends keyof HTMLElementTagNameMap>(name: K | `${K}.${string}`, properties: Properties = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const [tag = 'div', ...classes] = name.split('.');
  const element = document.createElement(tag) as HTMLElementTagNameMap[K];
  if (classes.length > 0) element.className = classes.join(' ');
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined) continue;
    if (key.includes('-') || key === 'role' || key === 'for') element.setAttribute(key, String(value));
    else Reflect.set(element, key, value);
  }
  element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
  return element;
}

export function button(text: string, onclick: () => void, properties: Properties = {}): HTMLButtonElement {
  return h('button', { type: 'button', onclick, ...properties }, text);
}

export function replaceChildren(element: Element, ...children: Child[]): void {
  element.replaceChildren(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
}

/** A check box with its label. */
export function checkbox(text: string, checked: boolean, onchange: (checked: boolean) => void, id?: string): HTMLLabelElement {
  const box = h('input', { type: 'checkbox', checked, id, onchange: () => onchange(box.checked) });
  return h('label.check', {}, box, text);
}

export interface SliderOptions {
  label: string;
  id: string;
  min: number;
  max: number;
  value: number;
  logarithmic?: boolean;
  unit?: string;
  text: (value: number) => string;
  onchange: (value: number) => void;
}

/** A slider that shows its value; logarithmic where the range spans decades. */
export function slider(options: SliderOptions): { element: HTMLElement; set: (value: number) => void; input: HTMLInputElement } {
  const { min, max } = options;
  const toPlace = (value: number): number =>
    options.logarithmic ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min);
  const toValue = (place: number): number => (options.logarithmic ? min * (max / min) ** place : min + place * (max - min));
  const output = h('output', { 'for': options.id }, '');
  const input = h('input', { type: 'range', id: options.id, min: '0', max: '1', step: '0.005' });
  const show = (value: number): void => {
    const text = `${options.text(value)}${options.unit ? ` ${options.unit}` : ''}`;
    output.textContent = text;
    input.setAttribute('aria-valuetext', text);
  };
  input.oninput = () => {
    const value = toValue(Number(input.value));
    show(value);
    options.onchange(value);
  };
  const set = (value: number): void => {
    input.value = String(toPlace(value));
    show(value);
  };
  set(options.value);
  return { element: h('div.slider', {}, h('label', { for: options.id }, options.label), output, input), set, input };
}

/** Saves bytes or text as a file, by the browser's own dialogue. */
export function download(name: string, content: string | Uint8Array): void {
  const url = URL.createObjectURL(new Blob([content as BlobPart], { type: 'application/octet-stream' }));
  const link = h('a', { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

export function prefersReducedMotion(): boolean {
  return matchMedia('(prefers-reduced-motion: reduce)').matches;
}
