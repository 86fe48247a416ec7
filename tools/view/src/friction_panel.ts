// SPDX-License-Identifier: Apache-2.0
// The friction curve and the materials of touch: which terms count, their sizes, and how the coefficient depends on slip speed.
import { checkbox, h, replaceChildren, slider } from './dom';
import { short } from './numbers';
import type { CurveTerm, Material, TouchParams } from './runtime';
import { cssColor } from './theme';

interface Term {
  name: CurveTerm;
  label: string;
  unit: string;
  min: number;
  max: number;
  value: number;
}

const TERMS: readonly Term[] = [
  { name: 'stribeck', label: 'Falls with speed (Stribeck)', unit: 'm/s', min: 0.001, max: 1, value: 0.05 },
  { name: 'viscous', label: 'Grows with speed (viscous)', unit: 's/m', min: 0.01, max: 10, value: 0.1 },
  { name: 'lag', label: 'Follows speed late (lag)', unit: 's', min: 0.001, max: 0.3, value: 0.03 },
  { name: 'presliding', label: 'Yields before it slips (presliding)', unit: 'N/m', min: 100, max: 1e6, value: 1e5 },
];

/** What some well-known materials are like, by a word of their names: coefficients, and stiffness by that of the slider. */
const KNOWN: readonly [RegExp, number, number, number][] = [
  [/rubber|tyre|tire|silicone/i, 1, 0.8, 0.5],
  [/steel|metal|iron|alumin|chrome|brass/i, 0.25, 0.18, 1.5],
  [/wood|cork/i, 0.5, 0.35, 1],
  [/ice|teflon|ptfe/i, 0.06, 0.03, 1.2],
  [/glass|ceramic/i, 0.35, 0.25, 1.5],
  [/skin|flesh|foam|cloth|fabric/i, 0.7, 0.6, 0.3],
];

/** What the materials of a graph feel like at first; undefined: none of them has a name that says so. */
export function usualMaterials(names: readonly string[], plain: Material): Material[] | undefined {
  return names.some((name) => KNOWN.some(([word]) => word.test(name))) ? names.map((name) => usualMaterial(name, plain)) : undefined;
}

function usualMaterial(name: string, plain: Material): Material {
  const known = KNOWN.find(([word]) => word.test(name));
  if (known === undefined) return { muStatic: plain.muStatic, muDynamic: plain.muDynamic, stiffness: plain.stiffness };
  return { muStatic: known[1], muDynamic: known[2], stiffness: Number((plain.stiffness * known[3]).toPrecision(3)) };
}

/** The coefficient at a slip speed (fdcg.h, "The curve"), lag and depth apart. */
export function frictionAt(p: TouchParams, speed: number): number {
  const { stribeck, viscous } = p.curve;
  const fall = stribeck === undefined ? 0 : (p.muStatic - p.muDynamic) / (1 + (speed / stribeck) ** 2);
  return p.muDynamic + fall + (viscous ?? 0) * speed;
}

export class FrictionPanel {
  readonly element = h('div.friction');
  private readonly graph = h('canvas.curve', { width: 300, height: 90, id: 'curve', role: 'img' });
  private readonly sizes: Record<CurveTerm, number>;
  private chosen = 0; // material

  constructor(
    private readonly params: TouchParams,
    private readonly names: readonly string[],
    private readonly onchange: () => void,
  ) {
    this.sizes = Object.fromEntries(TERMS.map((term) => [term.name, term.value])) as Record<CurveTerm, number>;
    this.element.append(this.curve());
    if (names.length > 0) this.element.append(this.materials());
  }

  private curve(): HTMLElement {
    const rows = TERMS.map((term) => {
      const one = slider({
        label: term.label,
        id: `curve-${term.name}`,
        min: term.min,
        max: term.max,
        value: term.value,
        logarithmic: true,
        unit: term.unit,
        text: short,
        onchange: (value) => {
          this.sizes[term.name] = Number(value.toPrecision(3));
          if (term.name in this.params.curve) this.setTerm(term.name, true);
        },
      });
      const box = checkbox('', false, (on) => this.setTerm(term.name, on), `with-${term.name}`);
      box.querySelector('input')!.setAttribute('aria-label', term.label);
      return h('div.term', {}, box, one.element);
    });
    return h('details.curve-box', { id: 'curve-box', ontoggle: () => this.draw() }, h('summary', {}, 'Friction curve'), ...rows, this.graph);
  }
  private setTerm(term: CurveTerm, on: boolean): void {
    if (on) this.params.curve[term] = this.sizes[term];
    else delete this.params.curve[term];
    this.onchange();
  }

  // ---- materials

  private materials(): HTMLElement {
    const place = h('div');
    const choose = h('select', { id: 'material', 'aria-label': 'Material', onchange: () => this.showMaterial(place, Number(choose.value)) });
    for (const [i, name] of this.names.entries()) choose.append(h('option', { value: String(i) }, name));
    const box = checkbox('Materials feel different', this.params.materials !== undefined, (on) => this.useMaterials(on, place), 'with-materials');
    this.showMaterial(place, 0);
    return h('details.curve-box', { id: 'material-box', open: true }, h('summary', {}, `Materials (${this.names.length})`), box, choose, place);
  }
  private useMaterials(on: boolean, place: HTMLElement): void {
    if (on) this.params.materials = this.names.map((name) => usualMaterial(name, this.params));
    else delete this.params.materials;
    this.showMaterial(place, this.chosen);
    this.onchange();
  }
  private showMaterial(place: HTMLElement, index: number): void {
    this.chosen = index;
    const { materials } = this.params;
    const material = materials?.[index];
    if (materials === undefined || material === undefined) {
      replaceChildren(place);
      return;
    }
    const mu = (label: string, id: string, key: 'muStatic' | 'muDynamic'): ReturnType<typeof slider> =>
      slider({
        label,
        id,
        min: 0,
        max: 2,
        value: material[key],
        text: (v) => v.toFixed(2),
        onchange: (value) => {
          material[key] = Number(value.toFixed(2));
          if (key === 'muStatic' && material.muDynamic > material.muStatic) dynamic.set((material.muDynamic = material.muStatic));
          if (key === 'muDynamic' && material.muStatic < material.muDynamic) still.set((material.muStatic = material.muDynamic));
          this.onchange();
        },
      });
    const still = mu('Static friction of it', 'material-mu-s', 'muStatic');
    const dynamic = mu('Dynamic friction of it', 'material-mu-d', 'muDynamic');
    const plain = this.params.stiffness;
    const stiffness = slider({ label: 'Stiffness of it', id: 'material-stiffness', min: plain / 20, max: plain * 20, value: material.stiffness, logarithmic: true, unit: 'N/m', text: short, onchange: (value) => ((material.stiffness = Number(value.toPrecision(3))), this.onchange()) });
    replaceChildren(place, still.element, dynamic.element, stiffness.element);
  }

  // ---- the curve drawn

  draw(): void {
    const { graph, params } = this;
    const width = Math.max(1, graph.clientWidth || 300);
    const height = 90;
    graph.width = width;
    graph.height = height;
    const context = graph.getContext('2d')!;
    const fastest = Math.max(0.1, 4 * (params.curve.stribeck ?? 0));
    const most = 1.15 * Math.max(params.muStatic, frictionAt(params, fastest), 0.1);
    const y = (mu: number): number => height - 14 - (mu / most) * (height - 20);
    context.strokeStyle = cssColor('force');
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(0, y(0));
    context.lineTo(0, y(params.muStatic));
    for (let x = 0; x <= width; ++x) context.lineTo(x, y(frictionAt(params, (x / width) * fastest)));
    context.stroke();
    context.fillStyle = cssColor('quiet');
    context.font = '11px system-ui, sans-serif';
    context.fillText(`0 to ${short(fastest)} m/s of slip: coefficient ${short(params.muStatic)} at rest, ${short(frictionAt(params, fastest))} at the end`, 2, height - 2);
    graph.setAttribute('aria-label', `Coefficient of friction over slip speed: ${short(params.muStatic)} at rest, ${short(frictionAt(params, fastest / 4))} at ${short(fastest / 4)} m/s, ${short(frictionAt(params, fastest))} at ${short(fastest)} m/s`);
  }
}
