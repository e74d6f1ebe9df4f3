// SPDX-License-Identifier: GPL-3.0-or-later
// What the page shows and what happens when somebody touches it. The view is the only state; its parts are drawn from it.
import { readAddress, writeAddress, type CameraMode, type ColourMode, type Pose, type View } from './data/address.ts';
import { overviewOf, overviewPose } from './data/overview.ts';
import { search, type Found } from './data/search.ts';
import { isEmpty, type Site } from './data/site.ts';
import { areElsewhere, centreOf, directionOfRow, type Filter, type Space } from './data/spaces.ts';
import { fetchDetails } from './data/voxel_details.ts';
import { centreOfVoxel, idOfVoxel, parseVoxelId, textOfId, voxelOfId, type Vector, type VoxelIndex } from './data/voxel_id.ts';
import { Card, type PickedVoxel } from './interface/card.ts';
import { h, iconButton, isTyping } from './interface/dom.ts';
import { formatMetres } from './interface/format.ts';
import { makeHelp } from './interface/help.ts';
import { listenToKeys } from './interface/keyboard.ts';
import { Legend } from './interface/legend.ts';
import { Notices } from './interface/notices.ts';
import { SidePanel } from './interface/side_panel.ts';
import { skyColours, startTheme, toggleTheme } from './interface/theme.ts';
import { Timeline } from './interface/timeline.ts';
import { canColourBy, Toolbar } from './interface/toolbar.ts';
import { Viewer, type Pick } from './scene/viewer.ts';
import type { VoxelTile } from './scene/voxel_tile.ts';

const SETTLE_MS = 300; // a view that rests this long gets into the address
const CLICK_PIXELS = 5; // farther is a drag
const PLACE_DISTANCE = 14; // [m] from which a place that was searched for is seen
const SPACE_DISTANCE = 27; // [m]

interface State {
  colour: ColourMode;
  epoch: string;
  before: string | null;
  split: number;
  filter: Filter;
  space: string | null;
  voxel: string | null;
}

export class App {
  private readonly canvas = h('canvas', { tabindex: 0, role: 'img', 'aria-label': 'The map in three dimensions. Arrow keys move, Shift and arrow keys turn, plus and minus zoom, question mark for help.' });
  private readonly measureLabel = h('div', { class: 'measure-label', hidden: true });
  private readonly walkPad: HTMLElement;
  private readonly viewer: Viewer;
  private readonly panel: SidePanel;
  private readonly toolbar: Toolbar;
  private readonly timeline: Timeline;
  private readonly legend: Legend;
  private readonly card: Card;
  private readonly notices: Notices;
  private readonly help = makeHelp();
  private state: State;
  private spaces: readonly Space[] = [];
  private picked: PickedVoxel | null = null;
  private wanted: VoxelIndex | null = null; // a voxel of the address or the search whose tile is still to come
  private measured: Vector[] | null = null; // while measuring: the points so far
  private settleTimer = 0;
  private isAtHome = true; // nobody has moved yet

  constructor(root: HTMLElement, private readonly site: Site, budgetBytes: number) {
    document.title = site.name;
    this.state = this.initialState();
    this.notices = new Notices(() => this.viewer.retry());
    this.panel = new SidePanel(site, { search: (text) => this.search(text), filter: (filter) => this.change({ filter }), choose: (space) => this.chooseSpace(space, true) });
    this.toolbar = new Toolbar(site, {
      camera: (mode) => this.switchCamera(mode), colour: (colour) => this.change({ colour }), measure: () => this.toggleMeasuring(),
      home: () => this.goHome(), share: () => this.share(), theme: () => this.switchTheme(), help: () => this.help.showModal(),
    });
    this.timeline = new Timeline(site.epochs, {
      epoch: (epoch) => this.changeEpoch(epoch), compare: (before) => this.change({ before }), split: (split) => this.changeSplit(split),
    });
    this.legend = new Legend(() => this.turnNorth());
    this.card = new Card(site, { close: () => this.clear(), epoch: (epoch) => this.changeEpoch(epoch), copy: (text) => this.copy(text, 'Voxel id copied') });
    this.walkPad = this.makeWalkPad();
    root.replaceChildren(this.panel.element, h('main', { class: 'stage' }, this.canvas, this.timeline.curtain, this.measureLabel, this.toolbar.element, this.legend.compass,
      this.card.element, this.legend.element, this.legend.scale, this.walkPad, this.timeline.element, this.notices.element), this.help);
    this.viewer = new Viewer(this.canvas, site, this.picture(), budgetBytes, {
      moved: () => this.moved(), progress: (isLoading) => this.progress(isLoading), failed: (url) => this.notices.fail(url), pending: () => { document.documentElement.dataset.view = 'loading'; }, arrived: () => this.arrived(), drawn: (isLoading) => this.drawn(isLoading),
    });
    this.start();
  }

  setSpaces(spaces: readonly Space[]): void {
    this.spaces = spaces;
    if (spaces.length === 0) this.panel.sayNoSpaces('This map has no parking spaces.');
    else if (areElsewhere(spaces, this.site)) {
      this.spaces = [];
      this.panel.sayNoSpaces(`The ${spaces.length} spaces of this site lie elsewhere, not in this map.`);
    }
    this.viewer.setSpaces(this.spaces);
    this.arrived();
    this.render();
  }

  sayNoSpaces(reason: string): void {
    this.panel.sayNoSpaces(reason);
  }

  /** For tests and measurements. */
  statistics() {
    return { ...this.viewer.statistics(), pose: this.viewer.rig.pose() };
  }

  /** Where a place of the map is on the canvas [CSS pixels]. */
  project(point: Vector) {
    return this.viewer.project(point);
  }

  private start(): void {
    this.viewer.rig.isStill = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    startTheme(() => this.paintSky());
    this.paintSky();
    this.listen();
    this.restore(readAddress(location.hash));
    if (this.site.epsg === null) this.notices.say('This map has local coordinates: its place on Earth is not known.');
    if (isEmpty(this.site)) this.notices.showHint('This map is empty: it holds no voxels.');
    else if (!location.hash) this.notices.showHint(`Drag to turn, scroll to zoom. Click ${this.site.spaces ? 'a parking space, or anything else,' : 'anything'} to see what it is.`);
  }

  private initialState(): State {
    const colour = canColourBy('color', this.site) ? 'color' : 'height';
    return { colour, epoch: this.site.epochs.at(-1)!.id, before: null, split: 0.5, filter: 'all', space: null, voxel: null };
  }

  private picture() {
    const { epoch, before, split, colour, space } = this.state;
    return { epoch, before: before === epoch ? null : before, split, colour, selectedSpace: space };
  }

  /** The address of the view as it is. */
  private address(): string {
    const { epoch, before, split, filter, colour, space, voxel } = this.state;
    const view: View = { pose: this.viewer.rig.pose(), colour, epoch, filter, before: before ?? undefined, split, space: space ?? undefined, voxel: voxel ?? undefined };
    return writeAddress(view);
  }

  /** A step that the back button takes back: the view before it stays in the history as it was. */
  private change(changes: Partial<State>): void {
    history.replaceState(null, '', this.address());
    Object.assign(this.state, changes);
    history.pushState(null, '', this.address());
    this.render();
  }

  private render(): void {
    const { epoch, before, split, filter, colour, space } = this.state;
    this.viewer.setPicture(this.picture());
    this.toolbar.show(this.viewer.rig.mode, colour, this.measured !== null);
    this.timeline.show(epoch, before === epoch ? null : before, split);
    this.legend.show(colour, this.site);
    if (this.spaces.length > 0) this.panel.showSpaces(this.spaces, epoch, filter, space);
    this.walkPad.hidden = this.viewer.rig.mode !== 'walk';
    this.renderCard();
    this.renderMarks();
  }

  private renderCard(): void {
    const space = this.spaces.find(({ id }) => id === this.state.space);
    if (this.measured) this.card.showDistance(this.measured[0] ?? null, this.measured[1] ?? null);
    else if (space) this.card.showSpace(space, this.state.epoch, this.picked);
    else if (this.picked) this.card.showVoxel(this.picked);
    else this.card.hide();
  }

  private renderMarks(): void {
    const lines: { positions: number[]; colour: string; width: number }[] = [];
    if (this.picked && !this.measured) {
      const edges = edgesOfVoxel(this.picked.voxel, this.picked.voxelSize);
      lines.push({ positions: edges, colour: '#ffffff', width: 4.5 }, { positions: edges, colour: '#1463ff', width: 2 });
    }
    const [from, to] = this.measured ?? [];
    if (from) {
      const cross = (point: Vector) => [0, 1, 2].flatMap((axis) => [-0.12, 0.12].flatMap((d) => point.map((x, i) => (i === axis ? x + d : x))));
      const positions = to ? [...cross(from), ...cross(to), ...from, ...to] : cross(from);
      lines.push({ positions, colour: '#ffffff', width: 5 }, { positions, colour: '#1463ff', width: 2.5 });
    }
    this.viewer.setMarks(lines);
    this.placeMeasureLabel();
  }

  private placeMeasureLabel(): void {
    const [from, to] = this.measured ?? [];
    const at = from && to ? this.viewer.project([0, 1, 2].map((i) => (from[i] + to[i]) / 2) as unknown as Vector) : null;
    this.measureLabel.hidden = at === null;
    if (!at) return;
    this.measureLabel.textContent = formatMetres(Math.hypot(...[0, 1, 2].map((i) => to[i] - from[i])));
    this.measureLabel.style.transform = `translate(${at.x}px, ${at.y}px) translate(-50%, -130%)`;
  }

  /** The view that an address describes, where it fits this site. */
  private restore(view: View): void {
    const initial = this.initialState();
    const has = (id: string | undefined) => this.site.epochs.some((epoch) => epoch.id === id);
    this.state = {
      colour: view.colour && canColourBy(view.colour, this.site) ? view.colour : initial.colour,
      epoch: has(view.epoch) ? view.epoch! : initial.epoch,
      before: has(view.before) ? view.before! : null,
      split: view.split ?? 0.5, filter: view.filter ?? 'all', space: view.space ?? null, voxel: view.voxel ?? null,
    };
    this.isAtHome = !view.pose;
    this.viewer.rig.set(view.pose ?? this.homePose());
    this.picked = null;
    const id = view.voxel ? parseVoxelId(view.voxel) : null;
    this.wanted = id === null ? null : voxelOfId(id);
    this.measured = null;
    this.render();
  }

  /** All of the map, or of its parking spaces. */
  private homePose(): Pose {
    const { min, max } = this.site.bounds;
    const corners: Vector[] = [min, max, [min[0], max[1], min[2]], [max[0], min[1], min[2]]];
    const points = this.spaces.length > 2 ? this.spaces.map(centreOf) : this.viewer.samplePoints();
    const overview = overviewOf(points.length > 0 ? points : corners);
    // A row of spaces is narrow; what stands beside it belongs to the picture.
    if (this.spaces.length > 2) overview.width = Math.max(overview.width, 15);
    return overviewPose(overview, this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1));
  }

  /** Tiles have come: now it is known where the map is dense. */
  private arrived(): void {
    if (this.isAtHome) this.viewer.rig.set(this.homePose());
  }

  private moved(): void {
    clearTimeout(this.settleTimer);
    this.settleTimer = window.setTimeout(() => history.replaceState(null, '', this.address()), SETTLE_MS);
  }

  private progress(isLoading: boolean): void {
    this.notices.progress(isLoading);
    if (!isLoading) this.notices.sayWhetherAllFailed(this.viewer.statistics().voxels === 0);
    this.legend.place(this.viewer.metresPerPixel(), this.viewer.rig.bearing());
    this.placeMeasureLabel();
    if (this.wanted) this.pickWanted(isLoading);
  }

  /** Marks for measurements, and the state of the picture for tests. */
  private drawn(isLoading: boolean): void {
    const markOnce = (name: string) => { if (performance.getEntriesByName(name).length === 0) performance.mark(name); };
    markOnce('first-picture');
    if (!isLoading) markOnce('full-view');
    document.documentElement.dataset.view = isLoading ? 'loading' : 'full';
  }

  private changeEpoch(epoch: string): void {
    this.picked = null;
    this.change({ epoch, voxel: null, before: this.state.before === epoch ? null : this.state.before });
  }

  private changeSplit(split: number): void {
    this.state.split = split;
    this.viewer.setPicture(this.picture());
    this.moved();
  }

  private switchCamera(mode: CameraMode): void {
    history.replaceState(null, '', this.address());
    const { target } = this.viewer.rig.pose();
    this.viewer.rig.switchTo(mode, (mode === 'walk' && this.viewer.standingPlace(target)) || target);
    history.pushState(null, '', this.address());
    this.render();
  }

  private goHome(): void {
    this.goTo(this.viewer.rig.mode === 'plan' ? { ...this.homePose(), mode: 'plan' } : this.homePose());
  }

  private goTo(pose: Pose): void {
    history.replaceState(null, '', this.address());
    this.viewer.rig.fly(pose);
    history.pushState(null, '', this.address());
    this.render();
  }

  private turnNorth(): void {
    const { rig } = this.viewer;
    if (rig.mode !== 'plan') rig.turn(rig.mode === 'walk' ? Math.PI / 2 - rig.bearing() : Math.PI / 2 - rig.bearing(), 0);
  }

  private chooseSpace(space: Space, isFlying: boolean): void {
    this.picked = isFlying ? null : this.picked;
    this.measured = null;
    this.change({ space: space.id, voxel: null });
    if (isFlying) {
      this.panel.open(false);
      this.viewer.rig.fly(this.viewer.rig.poseAt(centreOf(space), SPACE_DISTANCE, directionOfRow(space, this.spaces)));
      this.toolbar.show(this.viewer.rig.mode, this.state.colour, false);
    }
  }

  private search(text: string): void {
    const found = search(text, this.site, this.spaces);
    this.panel.say(answerTo(found));
    if (found.kind === 'space') this.chooseSpace(found.space, true);
    if (found.kind !== 'voxel' && found.kind !== 'place') return;
    this.measured = null;
    this.picked = null;
    this.wanted = found.kind === 'voxel' ? voxelOfId(found.id) : null;
    this.change({ space: null, voxel: found.kind === 'voxel' ? textOfId(found.id) : null });
    this.viewer.rig.fly(this.viewer.rig.poseAt(found.point, found.kind === 'voxel' ? 5 : PLACE_DISTANCE));
    if (found.kind === 'place') this.card.showPlace(found.point);
    this.panel.open(false);
  }

  /** A click: a space, a voxel, or the end of a measured line. */
  private click(x: number, y: number): void {
    const pick = this.viewer.pick(x, y);
    if (this.measured) {
      if (pick) this.measured = this.measured.length === 1 ? [this.measured[0], pick.surface] : [pick.surface];
      this.render();
      return;
    }
    const space = this.viewer.pickSpace(x, y, pick);
    if (!pick && !space) return this.clear();
    this.wanted = null;
    this.picked = pick ? this.takeVoxel(pick.tile, pick.point) : null;
    const isFine = pick !== null && pick.tile.voxelSize < this.site.voxelSize * 1.01;
    if (space) this.chooseSpace(space, false);
    else this.change({ space: null, voxel: isFine ? textOfId(idOfVoxel((pick as Pick).voxel)) : null });
  }

  /** What is known at once of a voxel; the rest is fetched. */
  private takeVoxel(tile: VoxelTile, point: number): PickedVoxel {
    const picked: PickedVoxel = { voxel: tile.voxelAt(point), voxelSize: tile.voxelSize, label: tile.labelAt(point), change: tile.changeAt(point), details: tile.details ? 'loading' : 'coarse' };
    if (tile.details) this.fetchDetails(picked, tile, point, tile.details);
    return picked;
  }

  private async fetchDetails(picked: PickedVoxel, tile: VoxelTile, point: number, details: string): Promise<void> {
    try {
      picked.details = await fetchDetails(details, tile.firstDetail + point);
    } catch {
      picked.details = 'failed';
    }
    if (this.picked === picked) this.renderCard();
  }

  /** Picks the voxel of an address or a search once its tile is there. */
  private pickWanted(isLoading: boolean): void {
    const found = this.viewer.findVoxel(this.wanted!);
    if (found) {
      this.picked = this.takeVoxel(found.tile, found.point);
      this.wanted = null;
      this.render();
    } else if (!isLoading && !this.viewer.rig.isFlying) {
      this.wanted = null;
      this.panel.say('No voxel of that id is to be seen at this date.');
    }
  }

  private clear(): void {
    this.picked = null;
    this.wanted = null;
    this.measured = null;
    if (this.state.space !== null || this.state.voxel !== null) this.change({ space: null, voxel: null });
    else this.render();
  }

  private toggleMeasuring(): void {
    this.measured = this.measured ? null : [];
    this.canvas.classList.toggle('measuring', this.measured !== null);
    this.render();
  }

  private share(): void {
    history.replaceState(null, '', this.address());
    this.copy(location.href, 'Address of this view copied');
  }

  private async copy(text: string, message: string): Promise<void> {
    try {
      await navigator.clipboard.writeText(text);
      this.notices.say(message);
    } catch {
      this.notices.say('Copying is not allowed here; the address bar shows this view.');
    }
  }

  private switchTheme(): void {
    this.notices.say(toggleTheme() === 'dark' ? 'Dark' : 'Light');
    this.paintSky();
  }

  private paintSky(): void {
    const { low, high } = skyColours();
    this.viewer.setSky(low, high);
  }

  private makeWalkPad(): HTMLElement {
    const hold = (direction: string, isDown: boolean) => () => this.viewer.rig.press(direction, isDown);
    const button = (name: 'up' | 'down', label: string, direction: string) => iconButton(name, label, () => undefined, { onpointerdown: hold(direction, true), onpointerup: hold(direction, false), onpointerleave: hold(direction, false), onpointercancel: hold(direction, false) });
    return h('div', { class: 'walk-pad', hidden: true, role: 'group', 'aria-label': 'Walk' }, button('up', 'Walk forward', 'forward'), button('down', 'Walk back', 'back'));
  }

  private listen(): void {
    let down: { x: number; y: number } | null = null;
    this.canvas.addEventListener('pointerdown', (event) => { down = event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY } : null; });
    this.canvas.addEventListener('pointerup', (event) => {
      if (!down || Math.hypot(event.clientX - down.x, event.clientY - down.y) > CLICK_PIXELS) return;
      const { left, top } = this.canvas.getBoundingClientRect();
      this.click(event.clientX - left, event.clientY - top);
    });
    for (const type of ['pointerdown', 'wheel', 'keydown']) window.addEventListener(type, () => { this.isAtHome = false; }, { passive: true });
    this.canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    window.addEventListener('popstate', () => this.restore(readAddress(location.hash)));
    window.matchMedia('(prefers-reduced-motion: reduce)').addEventListener('change', (event) => { this.viewer.rig.isStill = event.matches; });
    listenToKeys(this.viewer.rig, {
      camera: (mode) => this.switchCamera(mode), search: () => this.panel.searchField.focus(), step: (by) => this.timeline.step(by), compare: () => this.timeline.toggleComparison(),
      measure: () => this.toggleMeasuring(), share: () => this.share(), home: () => this.goHome(), north: () => this.turnNorth(), help: () => this.help.showModal(), escape: () => this.escape(),
    });
  }

  private escape(): void {
    if (this.help.open) return;
    if (isTyping(document.activeElement)) (document.activeElement as HTMLElement).blur();
    this.canvas.classList.remove('measuring');
    this.clear();
  }
}

function answerTo(found: Found): string {
  switch (found.kind) {
    case 'space': return `Space ${found.space.id}`;
    case 'voxel': return 'Voxel';
    case 'place': return { map: 'Place in coordinates of the map', local: 'Place in local metres', geographic: 'Place by latitude and longitude' }[found.as];
    case 'outside': return 'That place is not in this map.';
    case 'nothing': return 'Nothing of that name. Try a space’s id, a voxel’s 16 digits, or two coordinates.';
  }
}

function edgesOfVoxel(voxel: VoxelIndex, voxelSize: number): number[] {
  const centre = centreOfVoxel(voxel, voxelSize);
  const half = 0.52 * voxelSize;
  const corner = (bits: number) => centre.map((x, axis) => x + ((bits >> axis) & 1 ? half : -half));
  const edges: number[] = [];
  for (let bits = 0; bits < 8; ++bits) for (const axis of [0, 1, 2]) if (!((bits >> axis) & 1)) edges.push(...corner(bits), ...corner(bits | (1 << axis)));
  return edges;
}
