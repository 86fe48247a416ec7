// SPDX-License-Identifier: Apache-2.0
// The switch of force shading; where the graph has no normals it is off, and says how to get them.
import { checkbox, h } from './dom';

export function shadingSwitch(hasNormals: boolean, onchange: (on: boolean) => void): HTMLElement {
  const box = checkbox('Shading: faces feel smooth', false, onchange, 'shading');
  const input = box.querySelector('input')!;
  input.disabled = !hasNormals;
  input.setAttribute('aria-describedby', 'shading-note');
  const why = hasNormals
    ? 'The friction cone stands along the interpolated normal. Creases stay sharp; which edges are creases was chosen when the graph was made (--crease).'
    : 'This graph has no normals, or all of it is flat. fdcg view and fdcg compile make them with --normals faces, and --crease says from which angle on an edge stays sharp.';
  return h('div.felt', {}, box, h('p.note', { id: 'shading-note' }, why));
}
