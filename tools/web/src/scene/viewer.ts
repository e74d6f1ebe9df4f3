// SPDX-License-Identifier: GPL-3.0-or-later
// The picture: one epoch, or two that meet at a line. Draws only when something changed.
import { Color, ColorManagement, LinearSRGBColorSpace, Ray, Raycaster, Scene, Vector2, Vector3, WebGLRenderer, WebGLRenderTarget } from 'three';
import type { ColourMode } from '../data/address.ts';
import type { Site } from '../data/site.ts';
import type { Space } from '../data/spaces.ts';
import { centreOfVoxel, type Vector, type VoxelIndex } from '../data/voxel_id.ts';
import { CameraRig } from './camera_rig.ts';
import { colourTable, ROWS } from './colours.ts';
import { nameInMiddle, NO_VOXEL, PICK_REACH, PICK_SIDE, surfaceOf } from './picking.ts';
import { Shading } from './shading.ts';
import { standingPlace } from './standing_place.ts';
import { outline, SpaceBoxes } from './space_boxes.ts';
import { StreamBudget, TileStream } from './tile_stream.ts';
import { VoxelTile, type SharedUniforms } from './voxel_tile.ts';

/** A voxel under the pointer. */
export interface Pick {
  tile: VoxelTile;
  point: number; // of the tile
  voxel: VoxelIndex;
  surface: Vector; // [m, map-local] where the ray meets it
  epoch: string;
}

export interface ViewerEvents {
  moved(): void;
  progress(isLoading: boolean): void;
  failed(url: string): void;
  arrived(): void; // the first tiles, before they are drawn
  pending(): void; // what is on the screen is no longer true
  drawn(isLoading: boolean): void; // voxels are on the screen, all that the view needs or some
}

/** What to show, besides the camera. */
export interface Picture {
  epoch: string;
  before: string | null;
  split: number; // share of the width that is of `before`
  colour: ColourMode;
  selectedSpace: string | null;
}

const BADGE_REACH_PIXELS = 20;
const SLOW_FRAME_MS = 60;
const HURRY_MS = 12;
const FENCE_POLL_MS = 10;
const LOADING_POLL_MS = 60;
const SAMPLES_PER_TILE = 2000;
const COARSEST_GROUND = 0.5; // [m] coarser voxels say little of where one can stand

ColorManagement.enabled = false; // colours are sRGB from the table to the screen

export class Viewer {
  readonly rig: CameraRig;
  private readonly renderer: WebGLRenderer;
  private readonly shading = new Shading();
  private readonly voxelScene = new Scene();
  private readonly markScene = new Scene();
  private readonly streams = new Map<string, TileStream>(); // by tileset: several epochs may show the same
  private readonly boxes = new Map<string, SpaceBoxes>();
  private readonly byNumber = new Map<number, VoxelTile>();
  private readonly pickTarget = new WebGLRenderTarget(PICK_SIDE, PICK_SIDE);
  private readonly budget: StreamBudget;
  private readonly shared: SharedUniforms;
  private readonly site: Site;
  private readonly events: ViewerEvents;
  private picture: Picture;
  private spaces: readonly Space[] = [];
  private marks: ReturnType<typeof outline>[] = [];
  private isRequested = false;
  private requests = 0; // of frames, so far
  private wasMoving = false;
  private lastFrame = 0;
  private hasVoxels = false;
  private readonly drawing: { fence: WebGLSync | null; callback: () => void }[] = [];
  private hasArrived = false;
  private loadingTimer = 0;
  private resolution = 1; // of the picture while moving on a slow machine
  private groundAt = new Vector2(Infinity, 0);

  constructor(canvas: HTMLCanvasElement, site: Site, picture: Picture, budgetBytes: number, events: ViewerEvents) {
    this.site = site;
    this.picture = picture;
    this.events = events;
    this.budget = new StreamBudget(budgetBytes);
    this.renderer = new WebGLRenderer({ canvas, antialias: false, depth: false, stencil: false, powerPreference: 'high-performance' });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV; // asking would wait for the compiler
    this.rig = new CameraRig(canvas, () => {
      this.requestFrame();
      events.moved();
    });
    this.shared = this.makeUniforms();
    this.rig.setExtent(new Vector3(...site.bounds.max).distanceTo(new Vector3(...site.bounds.min)));
    this.compile();
    setTimeout(() => this.hurry(), 0); // once the page has placed the camera
    new ResizeObserver(() => this.requestFrame()).observe(canvas);
    canvas.addEventListener('webglcontextrestored', () => this.requestFrame());
  }

  setPicture(picture: Picture): void {
    const areBoxesSame = picture.epoch === this.picture.epoch && picture.before === this.picture.before && picture.selectedSpace === this.picture.selectedSpace;
    this.picture = picture;
    if (!areBoxesSame) this.rebuildBoxes();
    this.requestFrame();
  }

  setSpaces(spaces: readonly Space[]): void {
    this.spaces = spaces;
    this.rebuildBoxes();
    this.requestFrame();
  }

  setSky(low: string, high: string): void {
    const vector = (css: string) => { const { r, g, b } = new Color(css); return new Vector3(r, g, b); };
    this.shading.setSky(vector(low), vector(high));
    this.requestFrame();
  }

  /** Lines over the picture: the picked voxel, a measured distance. Pairs of points. */
  setMarks(lines: { positions: number[]; colour: string; width: number }[]): void {
    for (const mark of this.marks) {
      mark.removeFromParent();
      mark.geometry.dispose();
      mark.material.dispose();
    }
    this.marks = lines.map(({ positions, colour, width }) => outline(positions, colour, width));
    for (const mark of this.marks) this.markScene.add(mark);
    this.requestFrame();
  }

  retry(): void {
    for (const stream of this.streams.values()) stream.retry();
    this.requestFrame();
  }

  requestFrame(): void {
    if (this.isRequested) return;
    this.isRequested = true;
    this.requests += 1;
    this.events.pending();
    requestAnimationFrame((now) => {
      this.isRequested = false;
      this.frame(now);
    });
  }

  /** The voxel at a place of the canvas [CSS pixels]; null where there is none. */
  pick(x: number, y: number): Pick | null {
    const { camera } = this.rig;
    const { width, height } = this.canvasSize();
    const epoch = this.epochAt(x / width);
    camera.setViewOffset(width, height, Math.floor(x) - PICK_REACH, Math.floor(y) - PICK_REACH, PICK_SIDE, PICK_SIDE);
    const found = this.pickThrough(epoch);
    camera.clearViewOffset();
    if (!found) return null;
    const ray = this.rayAt(x, y);
    return { ...found, surface: surfaceOf(found.voxel, found.tile.voxelSize, ray), epoch };
  }

  /** The space at a place of the canvas [CSS pixels]: its badge, or its box where no voxel hides it. */
  pickSpace(x: number, y: number, voxel: Pick | null): Space | null {
    const { width, height } = this.canvasSize();
    const boxes = this.boxes.get(this.epochAt(x / width));
    if (!boxes) return null;
    for (const [index, badge] of boxes.badges.children.entries()) {
      const at = badge.position.clone().project(this.rig.camera);
      const distance = Math.hypot(((at.x + 1) / 2) * width - x, ((1 - at.y) / 2) * height - y);
      if (badge.visible && at.z < 1 && distance < BADGE_REACH_PIXELS) return this.spaces[index];
    }
    const ray = this.rayAt(x, y);
    const hit = boxes.hit(ray);
    const depth = voxel ? new Vector3(...voxel.surface).distanceTo(ray.origin) : Infinity;
    return hit && hit.distance <= depth + 0.3 ? hit.space : null;
  }

  /** The finest voxel of a number that is loaded. */
  findVoxel(voxel: VoxelIndex): { tile: VoxelTile; point: number } | null {
    const stream = this.streams.get(this.tilesetOf(this.picture.epoch) ?? '');
    for (const tile of stream?.visibleTiles() ?? []) {
      if (tile.voxelSize > this.site.voxelSize * 1.01) continue;
      const point = tile.pointOf(voxel);
      if (point !== null) return { tile, point };
    }
    return null;
  }

  /** A place of the map on the canvas [CSS pixels]; null behind the eye. */
  project(point: Vector): { x: number; y: number } | null {
    const at = new Vector3(...point).project(this.rig.camera);
    const { width, height } = this.canvasSize();
    return at.z < 1 ? { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height } : null;
  }

  /** Metres that one CSS pixel spans at the target. */
  metresPerPixel(): number {
    const { eye, target } = this.rig.pose();
    const distance = new Vector3(...eye).distanceTo(new Vector3(...target));
    return (this.rig.mode === 'plan' ? 1 : distance) / this.pixelsPerUnit(this.canvasSize().height);
  }

  /** Some of the voxels that are shown, evenly taken [m, map-local]. */
  samplePoints(): Vector[] {
    const points: Vector[] = [];
    for (const tile of this.allTiles()) {
      const step = Math.ceil(tile.count / SAMPLES_PER_TILE);
      for (let i = 0; i < tile.count; i += step) points.push(centreOfVoxel(tile.voxelAt(i), tile.voxelSize));
    }
    return points;
  }

  statistics() {
    let voxels = 0;
    for (const tile of this.allTiles()) voxels += tile.count;
    return { voxels, cachedBytes: this.budget.bytes, calls: this.renderer.info.render.calls };
  }

  private makeUniforms(): SharedUniforms {
    const { min, max } = this.site.bounds;
    return {
      table: { value: colourTable(this.site.labels, this.site.epochs.length) },
      colourMode: { value: -1 },
      isPicking: { value: false },
      edgeStrength: { value: 0.22 },
      pixelsPerUnit: { value: 1 },
      heightRange: { value: new Vector3(min[2], 1 / Math.max(max[2] - min[2], 0.1), 0) },
    };
  }

  /** Shaders compile while the first tiles are fetched. */
  private compile(): void {
    const scene = new Scene();
    for (const part of VoxelTile.prototypes(this.shared)) scene.add(part);
    this.renderer.setRenderTarget(this.shading.target);
    this.renderer.compile(scene, this.rig.camera);
    this.renderer.setRenderTarget(null);
    this.shading.compile(this.renderer);
  }

  private shownEpochs(): string[] {
    const { epoch, before } = this.picture;
    return before && before !== epoch ? [before, epoch] : [epoch];
  }

  private epochAt(share: number): string {
    const { epoch, before, split } = this.picture;
    return before && share < split ? before : epoch;
  }

  private tilesetOf(epoch: string): string | null {
    return this.site.epochs.find(({ id }) => id === epoch)?.tileset ?? null;
  }

  /** Tilesets of what is shown, each once. */
  private shownTilesets(): Set<string> {
    return new Set(this.shownEpochs().map((epoch) => this.tilesetOf(epoch)).filter((tileset) => tileset !== null));
  }

  private streamOf(tileset: string): TileStream {
    const known = this.streams.get(tileset);
    if (known) return known;
    const stream = new TileStream(new URL(tileset, document.baseURI).href, this.site, this.budget, this.shared, this.byNumber, {
      changed: () => this.requestFrame(),
      failed: (url) => this.events.failed(url),
    });
    this.streams.set(tileset, stream);
    this.voxelScene.add(stream.tiles.group);
    return stream;
  }

  /** Until there is a picture, fetching and unpacking do not wait for frames: the first may take its time. */
  private hurry(): void {
    if (this.hasVoxels) return;
    const { width, height } = this.canvasSize();
    this.rig.setAspect(width / height);
    const isLoading = this.updateStreams(width, height);
    if (!this.hasArrived && !isLoading && !this.allTiles().next().done) this.arrive();
    setTimeout(() => this.hurry(), HURRY_MS);
  }

  private arrive(): void {
    this.hasArrived = true;
    this.events.arrived();
    this.requestFrame();
  }

  private rebuildBoxes(): void {
    for (const boxes of this.boxes.values()) {
      for (const group of [boxes, boxes.marks, boxes.badges]) group.removeFromParent();
      boxes.dispose();
    }
    this.boxes.clear();
    if (!this.hasVoxels) return; // once there are some
    const epochs = this.site.epochs.map(({ id }) => id);
    for (const epoch of this.shownEpochs()) {
      const boxes = new SpaceBoxes(this.spaces, epoch, epochs, this.picture.selectedSpace);
      this.boxes.set(epoch, boxes);
      this.voxelScene.add(boxes);
      this.markScene.add(boxes.marks, boxes.badges);
    }
  }

  private canvasSize(): { width: number; height: number } {
    const { clientWidth, clientHeight } = this.renderer.domElement;
    return { width: Math.max(clientWidth, 1), height: Math.max(clientHeight, 1) };
  }

  private pixelsPerUnit(height: number): number {
    return 0.5 * height * Math.abs(this.rig.camera.projectionMatrix.elements[5]);
  }

  private frame(now: number): void {
    const request = this.requests;
    const { width, height } = this.canvasSize();
    this.rig.setAspect(width / height);
    const isMoving = this.rig.tick(now);
    this.adaptResolution(now, isMoving);
    this.resize(width, height);
    if (this.rig.mode === 'walk') this.followGround();
    const isLoading = this.updateStreams(width, height);
    const { voxels } = this.statistics();
    // Compiling shaders holds everything up, so first the tiles are asked for, then voxels are drawn, then all else.
    const canDraw = voxels > 0 && this.hasArrived;
    if (canDraw || !isLoading) this.draw(width, height);
    if (canDraw && !this.hasVoxels) this.finishFirstPicture();
    this.events.progress(isLoading);
    if (isMoving || this.resolution < 1) this.requestFrame();
    if (isLoading) this.watchLoading();
    if (this.hasVoxels) this.whenDrawn(() => this.events.drawn(isLoading || request !== this.requests));
    this.wasMoving = isMoving;
  }

  /** Nothing tells when the last of the tiles is there. */
  private watchLoading(): void {
    clearTimeout(this.loadingTimer);
    this.loadingTimer = window.setTimeout(() => {
      if ([...this.streams.values()].some((stream) => stream.isLoading)) this.watchLoading();
      else this.requestFrame();
    }, LOADING_POLL_MS);
  }

  private finishFirstPicture(): void {
    this.hasVoxels = true;
    this.rebuildBoxes();
    this.requestFrame();
  }

  /** Calls back, in order, once the graphics card has done what it was told so far. */
  private whenDrawn(callback: () => void): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    this.drawing.push({ fence: gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0), callback });
    gl.flush();
    if (this.drawing.length === 1) setTimeout(() => this.pollDrawing(gl), 0);
  }

  private pollDrawing(gl: WebGL2RenderingContext): void {
    const isDone = (fence: WebGLSync | null) => !fence || gl.isContextLost() || gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED;
    while (this.drawing.length > 0 && isDone(this.drawing[0].fence)) {
      const { fence, callback } = this.drawing.shift()!;
      gl.deleteSync(fence);
      callback();
    }
    if (this.drawing.length > 0) setTimeout(() => this.pollDrawing(gl), FENCE_POLL_MS);
  }

  /** On a slow machine a moving picture is coarser; once it rests it is drawn in full. */
  private adaptResolution(now: number, isMoving: boolean): void {
    const elapsed = now - this.lastFrame;
    this.lastFrame = now;
    if (!isMoving) this.resolution = 1;
    else if (this.wasMoving && elapsed > SLOW_FRAME_MS && elapsed < 2000) this.resolution = Math.max(0.4, this.resolution * 0.7);
  }

  private resize(width: number, height: number): void {
    const ratio = Math.min(window.devicePixelRatio, 2) * this.resolution;
    if (Math.abs(this.renderer.getPixelRatio() - ratio) > 1e-3) this.renderer.setPixelRatio(ratio);
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height, false);
    const pixels = this.renderer.getDrawingBufferSize(new Vector2());
    this.shading.setSize(pixels.x, pixels.y);
  }

  private updateStreams(width: number, height: number): boolean {
    const shown = this.shownTilesets();
    for (const [tileset, stream] of this.streams) if (!shown.has(tileset)) stream.rest();
    let isLoading = false;
    for (const tileset of shown) {
      const stream = this.streamOf(tileset);
      stream.update(this.rig.camera, width, height);
      isLoading ||= stream.isLoading;
    }
    return isLoading;
  }

  private draw(width: number, height: number): void {
    const { camera } = this.rig;
    const pixels = this.renderer.getDrawingBufferSize(new Vector2());
    this.shared.pixelsPerUnit.value = this.pixelsPerUnit(pixels.y);
    this.shared.colourMode.value = this.picture.colour === 'color' ? -1 : ROWS[this.picture.colour];
    for (const boxes of this.boxes.values()) boxes.setFaint(this.rig.mode === 'walk' || this.picture.colour !== 'color');
    for (const tile of this.allTiles()) tile.chooseShape(camera, this.pixelsPerUnit(pixels.y));
    const { target } = this.shading;
    this.renderer.setRenderTarget(target);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    const parts = this.parts();
    for (const { epoch, from, to } of parts) {
      target.scissor.set(Math.round(from * pixels.x), 0, Math.round(to * pixels.x) - Math.round(from * pixels.x), pixels.y);
      target.scissorTest = true;
      this.show(epoch);
      this.renderer.setRenderTarget(target);
      this.renderer.render(this.voxelScene, camera);
    }
    target.scissorTest = false;
    this.shading.draw(this.renderer, camera, this.pixelsPerUnit(pixels.y));
    this.drawMarks(parts, width, height);
  }

  private drawMarks(parts: { epoch: string; from: number; to: number }[], width: number, height: number): void {
    this.renderer.setScissorTest(true);
    for (const { epoch, from, to } of parts) {
      this.renderer.setScissor(Math.round(from * width), 0, Math.round((to - from) * width), height);
      this.show(epoch);
      this.boxes.get(epoch)?.placeBadges(this.rig.camera, height);
      this.renderer.render(this.markScene, this.rig.camera);
    }
    this.renderer.setScissorTest(false);
  }

  /** Shares of the width and what they show. */
  private parts(): { epoch: string; from: number; to: number }[] {
    const { epoch, before, split } = this.picture;
    return before ? [{ epoch: before, from: 0, to: split }, { epoch, from: split, to: 1 }] : [{ epoch, from: 0, to: 1 }];
  }

  private show(epoch: string): void {
    const shown = this.tilesetOf(epoch);
    for (const [tileset, stream] of this.streams) stream.tiles.group.visible = tileset === shown;
    for (const [id, boxes] of this.boxes) for (const group of [boxes, boxes.marks, boxes.badges]) group.visible = id === epoch;
  }

  private *allTiles(): Generator<VoxelTile> {
    for (const tileset of this.shownTilesets()) yield* this.streams.get(tileset)?.visibleTiles() ?? [];
  }

  /** What is under the pointer of an epoch's voxels, in a picture of their names. */
  private pickThrough(epoch: string): { tile: VoxelTile; point: number; voxel: VoxelIndex } | null {
    this.show(epoch);
    const boxes = this.boxes.get(epoch);
    if (boxes) boxes.visible = false;
    const pixelsPerUnit = this.shared.pixelsPerUnit.value;
    this.shared.pixelsPerUnit.value = this.pixelsPerUnit(PICK_SIDE);
    this.shared.isPicking.value = true;
    this.renderer.setRenderTarget(this.pickTarget);
    this.renderer.setClearColor(0xffffff, 1);
    this.renderer.clear();
    this.renderer.render(this.voxelScene, this.rig.camera);
    const bytes = new Uint8Array(4 * PICK_SIDE * PICK_SIDE);
    this.renderer.readRenderTargetPixels(this.pickTarget, 0, 0, PICK_SIDE, PICK_SIDE, bytes);
    this.renderer.setRenderTarget(null);
    this.shared.isPicking.value = false;
    this.shared.pixelsPerUnit.value = pixelsPerUnit;
    if (boxes) boxes.visible = true;
    const name = nameInMiddle(bytes);
    const tile = this.byNumber.get(name >>> 20);
    return tile && name !== NO_VOXEL ? { tile, point: name & 0xfffff, voxel: tile.voxelAt(name & 0xfffff) } : null;
  }

  private rayAt(x: number, y: number): Ray {
    const { width, height } = this.canvasSize();
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.rig.camera);
    return caster.ray;
  }

  /** The walker's feet stay on what lies beneath: the highest of the voxels below the eye, in the finest level there. */
  private followGround(): void {
    const { eye } = this.rig.pose();
    if (this.groundAt.distanceTo(new Vector2(eye[0], eye[1])) < 0.25) return;
    const ground = this.groundBelow(eye);
    if (ground === null) return;
    this.groundAt.set(eye[0], eye[1]);
    this.rig.setGround(ground);
  }

  /** Near a place of the map; null where nobody could stand there. */
  standingPlace(near: Vector): Vector | null {
    return standingPlace(this.voxelCentres(), near);
  }

  private *voxelCentres(): Generator<Vector> {
    for (const tile of this.allTiles()) {
      if (tile.voxelSize > COARSEST_GROUND) continue;
      for (let i = 0; i < tile.count; ++i) yield centreOfVoxel(tile.voxelAt(i), tile.voxelSize);
    }
  }

  /** Height of the highest loaded voxel below a point, at most half a metre above a step and 8 m down; null where there is none. */
  groundBelow([x, y, z]: Vector): number | null {
    let best: number | null = null;
    for (const tile of this.allTiles()) {
      const top = tile.topBelow(x, y, z - 0.6);
      if (top !== null && top > z - 8 && (best === null || top > best)) best = top;
    }
    return best;
  }
}
