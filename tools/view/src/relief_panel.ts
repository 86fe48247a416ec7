// SPDX-License-Identifier: Apache-2.0
// Heights that are felt and not in the mesh: which kind, how high, how long.
import { h, slider } from './dom';
import { short } from './numbers';
import type { Relief } from './runtime';

type Kind = Relief['kind'];

interface Length {
  label: string;
  min: number; // of the object's size, as all
  max: number;
  value: number;
}

const HEIGHT: Length = { label: 'Height', min: 1e-5, max: 0.01, value: 0.001 };
const WAVELENGTH: Length = { label: 'Wavelength', min: 1e-3, max: 0.3, value: 0.02 };
const KINDS: Record<Kind, { name: string; note: string; lengths: readonly Length[] }> = {
  none: { name: 'none', note: '', lengths: [] },
  ridges: { name: 'ridges', note: 'One wave along x.', lengths: [HEIGHT, WAVELENGTH] },
  bumps: { name: 'bumps', note: 'A wave along each axis.', lengths: [HEIGHT, WAVELENGTH] },
  grain: {
    name: 'grain (noise)',
    note: 'Sixteen waves in random directions.',
    lengths: [
      { ...HEIGHT, label: 'Height (root mean square)', value: 0.0005 },
      { ...WAVELENGTH, label: 'Shortest wave', value: 0.01 },
      { ...WAVELENGTH, label: 'Longest wave', value: 0.04 },
    ],
  },
  image: { name: 'images of the graph', note: 'As high as the file says.', lengths: [] },
};

/** Shown, and taken, with three digits. */
function rounded(metres: number): number {
  return Number(metres.toPrecision(3));
}

export class ReliefPanel {
  readonly element: HTMLElement;
  private readonly numbers: Record<Kind, number[]>;

  constructor(metres: number, hasHeights: boolean, onchange: (relief: Relief) => void) {
    const kinds = (Object.keys(KINDS) as Kind[]).filter((kind) => kind !== 'image' || hasHeights);
    this.numbers = Object.fromEntries(Object.entries(KINDS).map(([kind, { lengths }]) => [kind, lengths.map(({ value }) => rounded(value * metres))])) as Record<Kind, number[]>;
    const say = (kind: Kind): void => onchange({ kind, numbers: [...this.numbers[kind]] });
    const sliders = (kind: Kind): HTMLElement[] =>
      KINDS[kind].lengths.map(({ label, min, max, value }, i) =>
        slider({
          label,
          id: `relief-${kind}-${i}`,
          min: min * metres,
          max: max * metres,
          value: value * metres,
          logarithmic: true,
          unit: 'mm',
          text: (v) => short(rounded(v) * 1000),
          onchange: (v) => {
            this.numbers[kind][i] = rounded(v);
            say(kind);
          },
        }).element,
      );
    const places = kinds.map((kind) => h('div.sliders', { hidden: kind !== 'none', id: `relief-of-${kind}` }, KINDS[kind].note !== '' && h('p.note', {}, KINDS[kind].note), ...sliders(kind)));
    const choose = h('select', {
      id: 'relief',
      'aria-label': 'Kind of relief',
      onchange: () => {
        const kind = choose.value as Kind;
        for (const [i, place] of places.entries()) place.hidden = kinds[i] !== kind;
        say(kind);
      },
    });
    for (const kind of kinds) choose.append(h('option', { value: kind }, KINDS[kind].name));
    const note = h('p.note', {}, 'Heights that are felt and not in the mesh: fully from eight times as deep on.');
    this.element = h('details.curve-box.felt', { id: 'relief-box' }, h('summary', {}, 'Relief'), note, choose, ...places);
  }
}
