// SPDX-License-Identifier: Apache-2.0
// What touch feels like: sliders for the contact, the friction curve and materials, shading, relief and effects, how deep and how
// fast the hand goes.
import { h, slider } from './dom';
import { EffectPanel } from './effect_panel';
import { FrictionPanel, usualMaterials } from './friction_panel';
import { short } from './numbers';
import { ReliefPanel } from './relief_panel';
import { NONE, type Runtime, type TouchParams } from './runtime';
import { shadingSwitch } from './shading_switch';

const FASTEST = 10; // of the object's size a second: beyond, the hand is as fast as the pointer

/** A stiffness at which pressing by a hundredth of the object gives some newtons. */
function usualStiffness(metres: number): number {
  const wanted = 5 / (0.01 * metres);
  return metres >= 0.02 && metres <= 2 ? 1000 : Number(wanted.toPrecision(1));
}

export interface SettingsListener {
  params(params: TouchParams): void; // that the runtime takes
  depth(): void;
  hand(metresPerS: number): void; // its largest speed; 0: that of the pointer
}

export class TouchSettings {
  readonly element = h('div');
  /** The last that the runtime took. */
  params: TouchParams;
  depth = 0.015; // of the object's size
  handSpeed = 0;
  private readonly wanted: TouchParams;
  private readonly contact = h('fieldset'); // a recording has one set of these
  private readonly friction: FrictionPanel;
  private readonly relief: HTMLElement;
  private readonly effects: HTMLElement;
  private readonly refusal = h('p.remark', { role: 'alert', id: 'refusal', hidden: true });
  private readonly names: string[];
  private readonly muSliders: Record<'muStatic' | 'muDynamic', (v: number) => void>;
  private readonly depthSlider: (v: number) => void;

  constructor(
    private readonly runtime: Runtime,
    metres: number,
    private readonly listener: SettingsListener,
  ) {
    this.wanted = { muStatic: 0.6, muDynamic: 0.4, stiffness: usualStiffness(metres), damping: 0, curve: {}, shading: false, relief: { kind: 'none', numbers: [] }, effects: {} };
    this.names = runtime.materials();
    const materials = usualMaterials(this.names, this.wanted);
    if (materials !== undefined) this.wanted.materials = materials;
    this.params = structuredClone(this.wanted);
    this.friction = new FrictionPanel(this.wanted, this.names, () => this.set({}));
    this.relief = new ReliefPanel(metres, runtime.hasHeights, (relief) => this.set({ relief })).element;
    this.effects = new EffectPanel(metres, (effects) => this.set({ effects })).element;
    const { stiffness } = this.wanted;
    const mu = (label: string, id: string, which: 'muStatic' | 'muDynamic'): ReturnType<typeof slider> =>
      slider({ label, id, min: 0, max: 2, value: this.wanted[which], text: (v) => v.toFixed(2), onchange: (value) => this.setFriction(which, Number(value.toFixed(2))) });
    const still = mu('Static friction', 'mu-s', 'muStatic');
    const dynamic = mu('Dynamic friction', 'mu-d', 'muDynamic');
    const depth = slider({ label: 'Press depth', id: 'depth', min: 0.001, max: 0.08, value: this.depth, logarithmic: true, unit: 'mm', text: (v) => short(v * metres * 1000), onchange: (value) => this.setDepth(value) });
    const speed = slider({ label: 'Speed of the hand', id: 'hand-speed', min: 0.01, max: FASTEST, value: FASTEST, logarithmic: true, text: (v) => (v >= 0.99 * FASTEST ? 'that of the pointer' : `${short(v * metres)} m/s at most`), onchange: (value) => this.setHand(value >= 0.99 * FASTEST ? 0 : value * metres) });
    this.muSliders = { muStatic: still.set, muDynamic: dynamic.set };
    this.depthSlider = depth.set;
    this.contact.append(
      slider({ label: 'Stiffness', id: 'stiffness', min: stiffness / 50, max: stiffness * 20, value: stiffness, logarithmic: true, unit: 'N/m', text: short, onchange: (value) => this.set({ stiffness: Number(value.toPrecision(3)) }) }).element,
      still.element,
      dynamic.element,
      slider({ label: 'Damping', id: 'damping', min: 0, max: stiffness / 100, value: 0, unit: 'N s/m', text: short, onchange: (value) => this.set({ damping: Number(value.toPrecision(3)) }) }).element,
      this.friction.element,
      shadingSwitch(runtime.hasNormals, (shading) => this.set({ shading })),
      this.relief,
      this.effects,
    );
    this.element.append(depth.element, speed.element, this.contact);
  }

  set(change: Partial<TouchParams>): void {
    Object.assign(this.wanted, change);
    const refusal = this.runtime.setParams(this.wanted);
    if (refusal !== '') ('relief' in change ? this.relief : 'effects' in change ? this.effects : this.friction.element).after(this.refusal);
    this.refusal.hidden = refusal === '';
    this.refusal.textContent = refusal === '' ? '' : `Not taken: ${refusal}`;
    this.friction.draw();
    if (refusal !== '') return;
    this.params = structuredClone(this.wanted);
    this.listener.params(this.params);
  }
  /** Static friction is at least dynamic friction: the other one follows. */
  private setFriction(which: 'muStatic' | 'muDynamic', value: number): void {
    this.wanted[which] = value;
    if (this.wanted.muStatic < this.wanted.muDynamic) {
      const other = which === 'muStatic' ? 'muDynamic' : 'muStatic';
      this.wanted[other] = value;
      this.muSliders[other](value);
    }
    this.set({});
  }
  private setDepth(value: number): void {
    this.depth = Math.min(0.08, Math.max(0.001, value));
    this.listener.depth();
    this.set({});
  }
  scaleDepth(factor: number): void {
    this.setDepth(this.depth * factor);
    this.depthSlider(this.depth);
  }
  private setHand(metresPerS: number): void {
    this.handSpeed = metresPerS;
    this.listener.hand(metresPerS);
  }

  /** Of the friction cone on a node (NONE: none). */
  mu(node: number, slips: boolean): number {
    const name = this.params.materials === undefined || node === NONE ? undefined : this.runtime.material(node);
    const material = name === undefined ? undefined : this.params.materials?.[this.names.indexOf(name)];
    const { muStatic, muDynamic } = material ?? this.params;
    return slips ? muDynamic : muStatic;
  }

  lock(on: boolean): void {
    this.contact.disabled = on;
  }
  draw(): void {
    this.friction.draw();
  }
}
