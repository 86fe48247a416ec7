// SPDX-License-Identifier: Apache-2.0
// What `fdcg repair --all` makes of the mesh: the account, and the result in place of it or beside it.
import type { Context } from './context';
import type { Item } from './data';
import { h } from './dom';
import { MeshModel } from './mesh_model';
import { MeshView } from './mesh_view';
import { grouped } from './numbers';

const BESIDE = 1.2; // of the object's size

export type Version = 'before' | 'after' | 'both';

export class RepairPanel {
  readonly element = h('section.repair', {}, h('h2', {}, 'Repaired'));
  private repaired: MeshView | undefined;
  version: Version = 'before';

  constructor(
    private readonly context: Context,
    private readonly from: NonNullable<Item['repaired']>,
    private readonly original: MeshView,
  ) {
    const report = from.report;
    const left = report.issues.filter((issue) => issue.severity === 'error').reduce((sum, issue) => sum + issue.total, 0);
    const done = (from.account?.actions ?? []).filter((action) => action.total > 0 || action.left.total > 0);
    const items = done.flatMap((action) => [action.total > 0 ? h('li', {}, action.message) : null, action.left.total > 0 ? h('li', {}, action.left.message) : null]);
    const choices = ([['before', 'As it is'], ['after', 'Repaired'], ['both', 'Side by side']] as const).map(([value, text]) => {
      const radio = h('input', { type: 'radio', name: 'version', value, id: `version-${value}`, checked: value === 'before', onchange: () => void this.show(value) });
      return h('label.check', {}, radio, text);
    });
    this.element.append(
      h('p.note', {}, left === 0 ? 'fdcg repair --all leaves no error.' : `fdcg repair --all leaves ${grouped(left)} error${left === 1 ? '' : 's'}.`),
      h('ul', {}, ...items),
      h('div.row', { role: 'radiogroup', 'aria-label': 'Which mesh is shown' }, ...choices),
    );
  }

  private async show(version: Version): Promise<void> {
    this.version = version;
    if (this.repaired === undefined && version !== 'before') {
      this.repaired = new MeshView(this.context.stage, await MeshModel.read(this.from.geometry, 1));
      this.context.stage.content.add(this.repaired.group);
    }
    this.original.group.visible = version !== 'after';
    if (this.repaired !== undefined) {
      this.repaired.group.visible = version !== 'before';
      this.repaired.group.position.x = version === 'both' ? BESIDE : 0;
    }
    this.context.stage.fit();
  }

  /** Which of both meshes are on the stage. */
  get shown(): { before: boolean; after: boolean; apart: number } {
    return { before: this.original.group.visible, after: this.repaired?.group.visible === true, apart: this.repaired?.group.position.x ?? 0 };
  }

  applyTheme(): void {
    this.repaired?.applyTheme();
  }
}
