// SPDX-License-Identifier: Apache-2.0
// Findings by rule: a list to filter and to walk through; what is chosen is flown to.
import type { Context, Tab } from './context';
import type { Element3, Issue, Item, Rule } from './data';
import { button, checkbox, h, replaceChildren } from './dom';
import type { MeshView } from './mesh_view';
import { grouped } from './numbers';
import { RepairPanel } from './repair_panel';

const SHOWN_AT_ONCE = 100;

interface Entry {
  issue: Issue;
  element: Element3;
}

function list(name: string, numbers: readonly (number | string)[] | undefined): string {
  if (numbers === undefined || numbers.length === 0) return '';
  const shown = numbers.slice(0, 4).join(', ');
  return `${name}${numbers.length > 1 ? 's' : ''} ${shown}${numbers.length > 4 ? ', ...' : ''}`;
}

export function describe(element: Element3): string {
  const parts = [
    list('edge', element.edges?.map(([a, b]) => `${a}-${b}`)),
    list('vertex', element.vertices).replace('vertexs', 'vertices'),
    list('face', element.faces),
    element.line !== undefined ? `line ${element.line}` : '',
  ];
  return parts.filter((part) => part !== '').join(' · ') || 'the file';
}

/** What a filter asks for: a kind of number, or words. */
function matcher(text: string): ((entry: Entry) => boolean) | undefined {
  const wanted = text.trim().toLowerCase();
  if (wanted === '') return undefined;
  const numbered = /^(face|vertex|line)?\s*(\d+)$/.exec(wanted);
  if (numbered === null) return ({ issue, element }) => issue.rule.includes(wanted) || issue.severity.startsWith(wanted) || (element.part ?? '').toLowerCase().includes(wanted);
  const n = Number(numbered[2]);
  return ({ element }) => {
    const isFace = numbered[1] !== 'vertex' && numbered[1] !== 'line' && (element.faces ?? []).includes(n);
    const isVertex = (numbered[1] ?? 'vertex') === 'vertex' && ((element.vertices ?? []).includes(n) || (element.edges ?? []).some((edge) => edge.includes(n)));
    const isLine = (numbered[1] ?? 'line') === 'line' && element.line === n;
    return isFace || isVertex || isLine;
  };
}

export class FindingsTab implements Tab {
  readonly id = 'findings';
  readonly title = 'Findings';
  readonly element = h('div.tab');
  private readonly results = h('div.results');
  private readonly filter: HTMLInputElement;
  private entries: Entry[] = [];
  private current = -1;
  private readonly repair: RepairPanel | undefined;
  private readonly open = new Map<string, number>(); // rule -> how many are listed

  constructor(
    private readonly context: Context,
    private readonly item: Item,
    private readonly view: MeshView | undefined,
  ) {
    this.filter = h('input', {
      type: 'search',
      id: 'filter',
      placeholder: 'rule, face 12, vertex 3, line 40',
      'aria-label': 'Filter findings by rule, part, element or line',
      oninput: () => this.list(),
    });
    this.element.append(this.summary());
    if (this.issues.length > 0) this.element.append(this.tools(), this.results);
    if (item.repaired !== undefined && view !== undefined) {
      this.repair = new RepairPanel(context, item.repaired, view);
      this.element.insertBefore(this.repair.element, this.element.children[1] ?? null);
    }
    if (item.no_graph !== undefined) this.element.append(h('p.note', { id: 'no-graph' }, `Nothing to touch: ${item.no_graph}.`));
    const first = this.issues[0];
    if (first !== undefined) this.open.set(first.rule, SHOWN_AT_ONCE);
    this.list();
  }

  private get issues(): Issue[] {
    return this.item.report?.issues ?? [];
  }

  private summary(): HTMLElement {
    const report = this.item.report!;
    const counts = (['error', 'warning', 'note'] as const)
      .map((severity) => [severity, this.issues.filter((issue) => issue.severity === severity).reduce((sum, issue) => sum + issue.total, 0)] as const)
      .filter(([, total]) => total > 0);
    const passes = report.verdict === 'pass';
    return h(
      'section.summary',
      {},
      h('p.verdict', { 'data-verdict': report.verdict }, passes ? 'Passes' : 'Fails'),
      h('p.counts', {}, counts.length === 0 ? 'No findings.' : counts.map(([severity, total]) => `${grouped(total)} ${severity}${total === 1 ? '' : 's'}`).join(', ')),
    );
  }

  private tools(): HTMLElement {
    return h(
      'div.finding-tools',
      {},
      this.filter,
      h('div.row', {}, button('Previous', () => this.go(-1), { id: 'previous', title: 'Previous finding (P)' }), button('Next', () => this.go(1), { id: 'next', title: 'Next finding (N)' }), h('span.place', { id: 'place' })),
    );
  }

  private list(): void {
    const matches = matcher(this.filter.value);
    this.entries = [];
    const groups = this.issues.map((issue) => {
      const found = issue.elements.map((element) => ({ issue, element })).filter((entry) => matches === undefined || matches(entry));
      const group = this.ruleGroup(issue, found, this.entries.length, matches !== undefined);
      this.entries.push(...found);
      return found.length > 0 || matches === undefined ? group : null;
    });
    this.current = -1;
    replaceChildren(this.results, ...groups, matches !== undefined && this.entries.length === 0 && h('p.empty', {}, 'Nothing matches the filter.'));
    this.showPlace();
  }

  private ruleGroup(issue: Issue, found: Entry[], first: number, isFiltered: boolean): HTMLElement {
    const rule: Rule | undefined = this.context.page.rules.find((known) => known.name === issue.rule);
    const shown = this.open.get(issue.rule) ?? SHOWN_AT_ONCE;
    const items = found.slice(0, shown).map((entry, k) =>
      h('li', {}, button(describe(entry.element), () => this.choose(first + k), { className: 'finding', 'data-entry': first + k })),
    );
    const more = found.length - shown;
    const details = h(
      'details.rule',
      { open: isFiltered || this.open.has(issue.rule), 'data-rule': issue.rule },
      h('summary', {}, h('span.dot', { 'data-severity': issue.severity, 'aria-hidden': 'true' }), h('span.rule-name', {}, issue.rule), h('span.total', {}, grouped(issue.total)), h('span.hidden', {}, issue.severity)),
      h('p.message', {}, issue.message),
      rule !== undefined && h('p.why', {}, rule.why),
      this.view !== undefined && checkbox('Show all on the model', this.view.layerShown(issue.rule), (checked) => this.view?.setLayer(issue, checked), `layer-${issue.rule}`),
      h('ol', {}, ...items),
      more > 0 &&
        button(`${grouped(Math.min(more, SHOWN_AT_ONCE))} more of ${grouped(more)}`, () => {
          this.open.set(issue.rule, shown + SHOWN_AT_ONCE);
          this.list();
        }),
      issue.elements.length < issue.total && h('p.note', {}, `The page holds the first ${grouped(issue.elements.length)} of ${grouped(issue.total)}; fdcg validate --full lists all.`),
    );
    details.ontoggle = () => {
      if (details.open && !this.open.has(issue.rule)) this.open.set(issue.rule, SHOWN_AT_ONCE);
      if (!details.open && !isFiltered) this.open.delete(issue.rule);
    };
    return details;
  }

  private showPlace(): void {
    const place = this.element.querySelector('#place');
    if (place !== null) place.textContent = this.entries.length === 0 ? '' : `${this.current + 1} of ${grouped(this.entries.length)}`;
  }

  go(step: number): void {
    if (this.entries.length === 0) return;
    const from = this.current < 0 && step < 0 ? 0 : this.current;
    this.choose((from + step + this.entries.length) % this.entries.length);
  }

  choose(index: number): void {
    const entry = this.entries[index];
    if (entry === undefined) return;
    this.current = index;
    this.view?.select(entry.element);
    this.showPlace();
    this.context.announce(`${entry.issue.severity}: ${entry.issue.rule}, ${describe(entry.element)}`);
    const fans = (this.view?.fanCount ?? 0) > 1 ? ` · ${this.view!.fanCount} fans of faces, a colour each` : '';
    this.context.hint(`${entry.issue.rule}: ${describe(entry.element)}${entry.element.part ? ` · ${entry.element.part}` : ''}${fans}`);
    for (const chosen of this.results.querySelectorAll('[aria-current]')) chosen.removeAttribute('aria-current');
    const item = this.results.querySelector<HTMLElement>(`[data-entry="${index}"]`);
    if (item === null) return;
    const group = item.closest('details');
    if (group !== null) group.open = true;
    item.setAttribute('aria-current', 'true');
    item.scrollIntoView({ block: 'nearest' });
  }

  activate(): void {
    const worst = this.issues.some((issue) => issue.severity === 'error') ? 'error' : 'warning'; // the rest on request: it would hide the worst
    for (const issue of this.issues) {
      if (issue.severity === worst && issue.elements.length <= 5000) this.view?.setLayer(issue, true);
    }
    if (this.element.querySelector('.rule') !== null) this.list();
  }
  deactivate(): void {
    for (const issue of this.issues) this.view?.setLayer(issue, false);
    this.view?.select(undefined);
    this.context.hint('');
  }
  key(event: KeyboardEvent): boolean {
    if (event.key === 'n') this.go(1);
    else if (event.key === 'p') this.go(-1);
    else if (event.key === '/') this.filter.focus();
    else if (event.key === 'Escape') {
      this.view?.select(undefined);
      this.context.hint('');
    } else return false;
    return true;
  }
  applyTheme(): void {
    this.repair?.applyTheme();
  }
  state(): Record<string, unknown> {
    const entry = this.entries[this.current];
    return { version: this.repair?.version, meshes: this.repair?.shown, ghost: this.view?.isGhost, entries: this.entries.length, current: this.current, rule: entry?.issue.rule, element: entry?.element };
  }
}
