// SPDX-License-Identifier: Apache-2.0
// The page: a head, a panel with tabs, the stage, and a dock under it.
import type { Context, Tab } from './context';
import { type Item, itemCount, type Page, readArray, readItem, readPage, readWasm } from './data';
import { button, checkbox, h, replaceChildren } from './dom';
import { FindingsTab, describe } from './findings_tab';
import { GraphModel } from './graph_model';
import { GraphTab } from './graph_tab';
import { makeHelp } from './help';
import { Frame } from './frame';
import { clearGroup } from './highlight';
import { MeshModel } from './mesh_model';
import { MeshView } from './mesh_view';
import { grouped, short } from './numbers';
import { quoted } from './recording';
import { Runtime } from './runtime';
import { Stage } from './stage';
import { toggleMode } from './theme';
import { LogTab } from './log_tab';
import { SessionTab } from './session_tab';
import { parseLog } from './touch_csv';
import { GOD, TICK } from './touch_messages';
import { TouchTab } from './touch_tab';

class App {
  private readonly stageHolder = h('div.stage');
  private readonly hintLine = h('p.hint');
  private readonly live = h('div.hidden', { 'aria-live': 'polite', role: 'status' });
  private readonly dockPlace = h('div.dock', { hidden: true });
  private readonly tabBar = h('div.tabs', { role: 'tablist', 'aria-label': 'Views' });
  private readonly tabBody = h('div.tab-body', { role: 'tabpanel', id: 'tab-body' });
  private readonly facts = h('div.facts');
  private readonly view = h('div.view-tools');
  private readonly help: HTMLDialogElement;
  private readonly stage: Stage;
  private readonly context: Context;
  private tabs: Tab[] = [];
  private active: Tab | undefined;
  private mesh: MeshView | undefined;
  private down: { x: number; y: number } | undefined;
  private item: Item | undefined;
  private chosen = 0;
  private showing: Promise<void> = Promise.resolve();

  constructor(page: Page, wasm: Uint8Array<ArrayBuffer>) {
    this.help = makeHelp(page.version);
    this.buildFrame();
    this.stage = new Stage(this.stageHolder);
    this.context = {
      stage: this.stage,
      page,
      wasm,
      announce: (text) => (this.live.textContent = text),
      hint: (text) => (this.hintLine.textContent = text),
      dock: (content) => {
        this.dockPlace.hidden = content === null;
        replaceChildren(this.dockPlace, content);
      },
    };
    this.warnOfBlank();
    this.stage.canvas.addEventListener('pointerdown', (event) => (this.down = { x: event.clientX, y: event.clientY }));
    this.stage.canvas.addEventListener('pointerup', (event) => this.onClick(event));
    document.addEventListener('keydown', (event) => this.onKey(event));
    matchMedia('(prefers-color-scheme: light)').addEventListener('change', () => this.applyTheme());
  }

  private buildFrame(): void {
    const panel = h('aside.panel', { 'aria-label': 'Findings and tools' }, this.facts, this.tabBar, this.tabBody);
    const place = document.getElementById('app')!;
    place.removeAttribute('aria-busy');
    replaceChildren(place, panel, h('main.main', {}, this.stageHolder, this.dockPlace), this.live, this.help);
    this.stageHolder.append(this.view, this.hintLine);
  }
  private warnOfBlank(): void {
    if (this.stage.isBlank) this.stageHolder.append(h('p.failure', { role: 'alert' }, 'This browser has no WebGL 2, so the model is not drawn. A current Chromium or Firefox has it.'));
  }

  private buildTools(): void {
    const edges = checkbox('Edges', false, (shown) => this.mesh?.setEdges(shown), 'show-edges');
    const winding = checkbox('Winding', true, (shown) => this.mesh?.setWinding(shown), 'show-winding');
    const patches = checkbox('Patches', false, (shown) => this.showColors('patches', shown), 'show-patches');
    patches.title = 'Faces joined across edges, a colour each (C)';
    const hasMaterials = (this.item?.materials?.length ?? 0) > 1;
    const inMaterials = hasMaterials && this.item?.report?.verdict !== 'fail'; // else front and back in two colours tell more
    const materials = checkbox('Materials', inMaterials, (shown) => this.showColors('materials', shown), 'show-materials');
    if (inMaterials) this.mesh?.setColors('materials');
    replaceChildren(
      this.view,
      this.mesh !== undefined && winding,
      this.mesh !== undefined && edges,
      this.mesh !== undefined && patches,
      this.mesh !== undefined && hasMaterials && materials,
      button('Fit', () => this.stage.fit(), { id: 'fit', title: 'Show all of it (F)' }),
      button('Theme', () => this.toggleTheme(), { id: 'theme', title: 'Dark or light (T)' }),
      button('Help', () => this.help.showModal(), { id: 'help', title: 'Keys and licences (?)' }),
    );
  }

  private showColors(by: 'patches' | 'materials', shown: boolean): void {
    const other = document.querySelector<HTMLInputElement>(`#show-${by === 'patches' ? 'materials' : 'patches'}`);
    if (other !== null) other.checked = false;
    this.mesh?.setColors(shown ? by : undefined);
    const count = this.mesh?.colorsShown?.count;
    const text = count === undefined ? '' : by === 'patches' ? `${grouped(count)} patch${count === 1 ? '' : 'es'}: faces joined across edges of two faces.` : `${grouped(count)} materials.`;
    this.context.hint(text);
    this.context.announce(text);
  }

  // ---- items

  // Shows the file chosen last, once the one before it stands: keys choose faster than a file is read.
  choose(index: number): Promise<void> {
    this.chosen = index;
    this.showing = this.showing
      .catch(() => undefined)
      .then(() => (this.chosen === index ? this.show(index) : undefined));
    return this.showing;
  }

  private async show(index: number): Promise<void> {
    this.active?.deactivate();
    this.context.dock(null);
    for (const tab of this.tabs) if (tab instanceof TouchTab) tab.dispose();
    clearGroup(this.stage.marks);
    this.tabs = [];
    this.active = undefined;
    this.mesh = undefined;
    this.stage.moving.clear();
    clearGroup(this.stage.content);
    const item = await readItem(index);
    this.item = item;
    await this.addMesh(item);
    if (item.report !== undefined) this.tabs.push(new FindingsTab(this.context, item, this.mesh));
    await this.addGraph(item);
    await this.addSession(item);
    this.showFacts(item, index);
    this.buildTools();
    this.buildTabs();
    const first = this.tabs.find((tab) => `#${tab.id}` === location.hash) ?? this.tabs[0];
    if (first !== undefined) this.activate(first);
    this.stage.fit();
  }

  private async addMesh(item: Item): Promise<void> {
    if (item.geometry === undefined) return;
    const model = await MeshModel.read(item.geometry, 1);
    this.mesh = new MeshView(this.stage, model);
    this.stage.content.add(this.mesh.group);
  }

  private async addGraph(item: Item): Promise<void> {
    if (item.graph === undefined) {
      if (item.log !== undefined) await this.addLog(item, undefined);
      return;
    }
    const graph = await readArray(item.graph);
    const runtime = await Runtime.make(this.context.wasm);
    runtime.open(graph);
    const scale = runtime.header().metresPerUnit;
    const known = this.mesh?.model.frame;
    const model = new GraphModel(runtime, known && new Frame(known.centre, known.size, scale));
    const showMesh = (shown: boolean): void => {
      if (this.mesh !== undefined) this.mesh.group.visible = shown;
    };
    const graphTab = new GraphTab(this.context, model, showMesh);
    const base = item.name.replace(/^.*\//, '');
    const isMesh = item.geometry !== undefined;
    const graphName = isMesh ? `${base.replace(/\.[^.]*$/, '')}.fdcg` : base;
    const compile = isMesh ? { compile: `fdcg compile ${quoted(base)} -o ${quoted(graphName)} ${item.compile_options ?? ''}` } : {};
    const touch = new TouchTab(this.context, { frame: model.frame, runtime, graph, graphName, ...compile });
    if (!isMesh) graphTab.showSurface = true;
    if (item.log !== undefined) await this.addLog(item, model);
    this.tabs.push(graphTab, touch);
  }

  private async addLog(item: Item, model: GraphModel | undefined): Promise<void> {
    if (item.log === undefined) return;
    const ticks = parseLog(new TextDecoder().decode(await readArray(item.log)));
    this.tabs.push(new LogTab(this.context, ticks, model?.frame ?? frameOfLog(ticks), model?.runtime, item.log.name));
  }

  private async addSession(item: Item): Promise<void> {
    if (item.session === undefined) return;
    const tab = new SessionTab(this.context, item.session, item.name);
    await tab.showWorld(0);
    this.tabs.push(tab);
  }

  private showFacts(item: Item, index: number): void {
    const count = itemCount();
    const choose = h('select', { id: 'item', 'aria-label': 'File', onchange: () => void this.choose(Number(choose.value)) });
    if (count > 1) void this.fillItems(choose, count, index);
    const report = item.report;
    const parts: string[] = [];
    if (report !== undefined) parts.push(`${grouped(report.faces)} faces`, `${grouped(report.vertices)} vertices`, `${grouped(report.components)} component${report.components === 1 ? '' : 's'}`);
    if (item.geometry !== undefined) parts.push(`size ${short(item.geometry.size)}`);
    replaceChildren(this.facts, h('h1', { title: item.name }, item.name.replace(/^.*\//, '')), count > 1 && choose, parts.length > 0 && h('p', {}, parts.join(' · ')));
  }

  private async fillItems(choose: HTMLSelectElement, count: number, index: number): Promise<void> {
    for (let i = 0; i < count; ++i) {
      const item = i === index ? this.item! : await readItem(i);
      choose.append(h('option', { value: String(i), selected: i === index }, `${item.name.replace(/^.*\//, '')}${item.report?.verdict === 'fail' ? ' (fails)' : ''}`));
    }
  }

  // ---- tabs

  private buildTabs(): void {
    replaceChildren(
      this.tabBar,
      ...this.tabs.map((tab, k) =>
        button(tab.title, () => this.activate(tab), { id: `tab-${tab.id}`, role: 'tab', 'aria-selected': 'false', 'aria-controls': 'tab-body', title: `${tab.title} (${k + 1})` }),
      ),
    );
    this.tabBar.hidden = this.tabs.length < 2;
  }

  private activate(tab: Tab): void {
    if (this.active === tab) return;
    this.active?.deactivate();
    this.active = tab;
    for (const other of this.tabBar.children) other.setAttribute('aria-selected', String(other.id === `tab-${tab.id}`));
    replaceChildren(this.tabBody, tab.element);
    tab.activate();
    this.stage.invalidate();
  }

  // ---- input

  private onClick(event: PointerEvent): void {
    const down = this.down;
    this.down = undefined;
    if (down === undefined || event.button !== 0 || Math.hypot(event.clientX - down.x, event.clientY - down.y) > 4) return;
    if (this.active instanceof GraphTab) this.active.pointer(event);
    else if (this.active instanceof FindingsTab) this.tellFace(event);
  }

  private tellFace(event: PointerEvent): void {
    const picked = this.mesh?.pick(event.clientX, event.clientY);
    if (picked === undefined || this.mesh === undefined) {
      this.mesh?.select(undefined);
      this.context.hint('');
      return;
    }
    const { model } = this.mesh;
    const line = model.faceLines?.[picked.face];
    const element = { faces: [picked.face], ...(line === undefined ? {} : { line }) };
    this.mesh.select(element, false);
    const part = this.item?.parts?.filter(([, first]) => first <= picked.face).at(-1)?.[0];
    const material = this.item?.materials?.[model.faceMaterials?.[picked.face] ?? 0xffff];
    const text = [describe(element), `vertices ${[...model.face(picked.face)].slice(0, 8).join(', ')}`, part, material].filter(Boolean).join(' · ');
    this.context.hint(text);
    this.context.announce(text);
  }

  private onKey(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || this.help.open) return;
    if (target.closest('input:not([type=checkbox]):not([type=range]), select, textarea') !== null && event.key !== 'Escape') return;
    if (event.key === ' ' && target.closest('button:not([role=tab][aria-selected=true]), summary, input') !== null) return;
    if (this.active?.key(event) === true || this.commonKey(event)) event.preventDefault();
  }

  private commonKey(event: KeyboardEvent): boolean {
    const number = Number(event.key);
    const tab = Number.isInteger(number) && event.key !== ' ' ? this.tabs[number - 1] : undefined;
    if (tab !== undefined) this.activate(tab);
    else if (event.key === 'f') this.stage.fit();
    else if (event.key === 't') this.toggleTheme();
    else if (event.key === 'e') document.getElementById('show-edges')?.click();
    else if (event.key === 'c') document.getElementById('show-patches')?.click();
    else if (event.key === 'w') document.getElementById('show-winding')?.click();
    else if (event.key === '?') this.help.showModal();
    else return false;
    return true;
  }

  private toggleTheme(): void {
    toggleMode();
    this.applyTheme();
  }
  private applyTheme(): void {
    this.stage.applyTheme();
    this.mesh?.applyTheme();
    for (const tab of this.tabs) tab.applyTheme();
    this.stage.invalidate();
  }

  /** For tests: so that the picture can be read. */
  draw(): void {
    this.stage.drawNow();
  }
  /** For tools/clip: the moments of the log that is shown. */
  times(): Float64Array {
    return this.active?.times?.() ?? new Float64Array();
  }
  /** For tests and scripts: what the page shows now. */
  state(): Record<string, unknown> {
    return {
      item: this.item?.name,
      tabs: this.tabs.map((tab) => tab.id),
      tab: this.active?.id,
      flying: this.stage.isFlying,
      camera: this.stage.camera.position.toArray(),
      target: this.stage.controls.target.toArray(),
      frames: this.stage.frames,
      wholeFrames: this.stage.wholeFrames,
      edges: this.mesh?.edgesShown,
      edgeCount: this.mesh?.edgeCount,
      drawn: this.mesh?.drawn,
      triangles: this.mesh?.model.triangleFace.length,
      colors: this.mesh?.colorsShown,
      slow: this.stage.isSlow,
      pixelRatio: this.stage.pixelRatio,
      ...this.active?.state(),
    };
  }
}

/** Where a log's graph is not at hand: about what it has moved over. */
function frameOfLog(ticks: Float64Array): Frame {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let at = 0; at < ticks.length; at += TICK) {
    for (let k = 0; k < 3; ++k) {
      low[k] = Math.min(low[k]!, ticks[at + GOD + k]!);
      high[k] = Math.max(high[k]!, ticks[at + GOD + k]!);
    }
  }
  const centre = low.map((x, k) => (x + high[k]!) / 2) as [number, number, number];
  return new Frame(centre, Math.max(...low.map((x, k) => high[k]! - x)) || 1, 1);
}

export async function start(): Promise<void> {
  const page = await readPage();
  document.title = page.title;
  const app = new App(page, await readWasm());
  Object.defineProperty(window, 'fdcgView', { value: { state: () => app.state(), draw: () => app.draw(), times: () => app.times() } });
  if (itemCount() === 0) throw new Error('it holds no file');
  await app.choose(0);
  performance.mark('shown'); // for measurements
}
