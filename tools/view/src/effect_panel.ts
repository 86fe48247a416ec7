// SPDX-License-Identifier: Apache-2.0
// Forces on top of the contact's: which are on, and their sizes.
import { checkbox, h, slider } from './dom';
import { short } from './numbers';
import { EFFECTS, type EffectKind, type TouchParams } from './runtime';

interface Size {
  label: string;
  unit: 'N' | 'N s/m' | 'N/m' | 'Hz' | 'ms' | 'mm' | 'N per m/s';
  min: number; // in the effect's own unit: SI; of mm: of the object's size
  max: number;
  value: number;
}

const FORCE: Size = { label: 'Force', unit: 'N', min: 0.01, max: 5, value: 0.5 };
const MOST_HZ = 490; // below half of the ticks a second: nothing faster is felt

/** In the order of what the effect takes (EFFECTS). */
const PANELS: Record<EffectKind, { label: string; note: string; sizes: readonly Size[] }> = {
  magnet: { label: 'Magnet', note: 'Draws the hand to the surface from outside.', sizes: [{ ...FORCE, value: 1 }, { label: 'Reach', unit: 'mm', min: 0.002, max: 0.2, value: 0.03 }] },
  viscosity: { label: 'Viscosity', note: 'Against the motion along the surface.', sizes: [{ label: 'Viscosity', unit: 'N s/m', min: 0.1, max: 100, value: 5 }] },
  'stick-slip': { label: 'Stick-slip', note: 'A spring along the surface, which lets go above its force.', sizes: [{ label: 'Stiffness', unit: 'N/m', min: 10, max: 5000, value: 300 }, FORCE] },
  vibration: { label: 'Vibration', note: 'A tone while touching, along the normal.', sizes: [FORCE, { label: 'Frequency', unit: 'Hz', min: 5, max: MOST_HZ, value: 100 }] },
  noise: { label: 'Noise', note: 'Between two frequencies, a third of the force as root mean square.', sizes: [FORCE, { label: 'Lowest frequency', unit: 'Hz', min: 5, max: 400, value: 50 }, { label: 'Highest frequency', unit: 'Hz', min: 10, max: MOST_HZ, value: 300 }] },
  tap: { label: 'Tap', note: 'Rings at first contact, by the speed of impact.', sizes: [{ label: 'Force by speed', unit: 'N per m/s', min: 0.1, max: 50, value: 5 }, { label: 'Frequency', unit: 'Hz', min: 5, max: MOST_HZ, value: 200 }, { label: 'Decay', unit: 'ms', min: 0.001, max: 0.2, value: 0.02 }] },
  pulse: { label: 'Pulse', note: 'Half a wave at first contact and again and again.', sizes: [FORCE, { label: 'Duration', unit: 'ms', min: 0.002, max: 0.5, value: 0.03 }, { label: 'Period', unit: 'ms', min: 0.02, max: 5, value: 0.5 }] },
};

export class EffectPanel {
  readonly element: HTMLElement;
  private readonly numbers: Record<EffectKind, number[]>;
  private readonly on: TouchParams['effects'] = {};

  constructor(
    private readonly metres: number,
    private readonly onchange: (effects: TouchParams['effects']) => void,
  ) {
    this.numbers = Object.fromEntries(Object.entries(PANELS).map(([kind, { sizes }]) => [kind, sizes.map((size) => this.inSi(size, size.value))])) as Record<EffectKind, number[]>;
    const note = h('p.note', {}, 'Forces on top of those of the contact, each limited by an account of its energy.');
    this.element = h('details.curve-box.felt', { id: 'effect-box' }, h('summary', {}, 'Effects'), note, ...(Object.keys(EFFECTS) as EffectKind[]).map((kind) => this.panel(kind)));
  }

  /** Shown, and taken, with three digits. */
  private inSi(size: Size, value: number): number {
    return Number((size.unit === 'mm' ? value * this.metres : value).toPrecision(3));
  }

  private panel(kind: EffectKind): HTMLElement {
    const { label, note, sizes } = PANELS[kind];
    const sliders = sizes.map((size, i) =>
      slider({
        label: size.label,
        id: `effect-${kind}-${i}`,
        min: size.min,
        max: size.max,
        value: size.value,
        logarithmic: true,
        unit: size.unit,
        text: (v) => short(this.inSi(size, v) * (size.unit === 'mm' || size.unit === 'ms' ? 1000 : 1)),
        onchange: (v) => {
          this.numbers[kind][i] = this.inSi(size, v);
          this.say(kind);
        },
      }),
    );
    for (const one of sliders) one.input.setAttribute('aria-label', `${label}: ${one.element.querySelector('label')!.textContent}`);
    const place = h('div.sliders', { hidden: true }, h('p.note', {}, note), ...sliders.map((one) => one.element));
    const box = checkbox(
      label,
      false,
      (isOn) => {
        place.hidden = !isOn;
        if (!isOn) delete this.on[kind];
        else this.on[kind] = [];
        this.say(kind);
      },
      `with-${kind}`,
    );
    return h('div.effect', {}, box, place);
  }

  private say(kind: EffectKind): void {
    if (kind in this.on) this.on[kind] = [...this.numbers[kind]];
    this.onchange({ ...this.on });
  }
}
