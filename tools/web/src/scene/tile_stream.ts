// SPDX-License-Identifier: GPL-3.0-or-later
// The tiles of one epoch, fetched as the view needs them. All epochs share one budget of memory.
import { Matrix4, type Camera, type Object3D, type OrthographicCamera, type PerspectiveCamera, type Points } from 'three';
import { TilesRenderer } from '3d-tiles-renderer';
import { GLTFExtensionsPlugin } from '3d-tiles-renderer/plugins';
import { LRUCache } from '3d-tiles-renderer/core';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import type { Site } from '../data/site.ts';
import { placeOf, VoxelTile, type SharedUniforms } from './voxel_tile.ts';

/** Pixels that a voxel of a coarser level may be wide before the finer ones are fetched. */
const ERROR_TARGET = 2.5;

/** Fields of 3d-tiles-renderer that work but that its types leave out. */
interface RendererState {
  usedSet: Set<object>;
  stats: { queued: number; downloading: number; parsing: number };
  rootLoadingState: number;
  processNodeQueue: { running: boolean }; // children of tiles that are to be looked at
}
interface LoadedTile {
  content: { uri: string };
  internal: { basePath: string };
}
interface FailedTile {
  parent: { geometricError: number } | null;
}
const ROOT_FAILED = -1;

/** Memory that the epochs share; so they do their queues, by default. */
export class StreamBudget {
  readonly cache = new LRUCache();

  constructor(bytes: number) {
    this.cache.maxBytesSize = bytes;
    this.cache.minBytesSize = 0.8 * bytes;
    this.cache.maxSize = 2000;
    this.cache.minSize = 1600; // below this only bytes count
  }

  /** One cache for all, which gives up first what the renderer would. */
  adopt(tiles: TilesRenderer): void {
    this.cache.unloadPriorityCallback = tiles.lruCache.unloadPriorityCallback;
    tiles.lruCache = this.cache;
  }

  get bytes(): number {
    return (this.cache as unknown as { cachedBytes: number }).cachedBytes;
  }
}

export interface StreamEvents {
  changed(): void; // something new can be drawn
  failed(url: string): void;
}

export class TileStream {
  readonly tiles: TilesRenderer;
  private failures: { tile: FailedTile; coarser: FailedTile['parent']; error: number }[] = [];
  private readonly hasHistory: boolean;
  private camera: Camera | null = null;
  private readonly events: StreamEvents;
  private readonly shared: SharedUniforms;
  private readonly byNumber: Map<number, VoxelTile>;

  /** byNumber: the tiles by the numbers that picking reads. */
  constructor(url: string, site: Site, budget: StreamBudget, shared: SharedUniforms, byNumber: Map<number, VoxelTile>, events: StreamEvents) {
    this.hasHistory = site.attributes.change || site.attributes.epoch;
    this.shared = shared;
    this.byNumber = byNumber;
    this.events = events;
    this.tiles = new TilesRenderer(url);
    budget.adopt(this.tiles);
    this.tiles.errorTarget = ERROR_TARGET;
    this.tiles.autoDisableRendererCulling = false;
    // It would count the index that all tiles share for each; the plugin counts what a tile holds.
    Object.assign(this.tiles, { calculateBytesUsed: () => 0 });
    this.tiles.registerPlugin(new GLTFExtensionsPlugin({ meshoptDecoder: MeshoptDecoder, metadata: false, rtc: false }));
    this.tiles.registerPlugin(this.voxelPlugin(new Matrix4().fromArray(site.localFromEcef)));
    this.listen();
  }

  /** Chooses and fetches what the camera sees; width, height [pixels]. */
  update(camera: PerspectiveCamera | OrthographicCamera, width: number, height: number): void {
    if (this.camera !== camera) {
      if (this.camera) this.tiles.deleteCamera(this.camera);
      this.tiles.setCamera(camera);
      this.camera = camera;
    }
    this.tiles.setResolution(camera, width, height);
    this.tiles.update();
    // At once: by themselves they wait for a frame, and a first frame may take its time.
    for (const queue of this.tiles.downloadQueue.originQueues.values()) queue.tryRunJobs();
    this.tiles.parseQueue.tryRunJobs();
  }

  /** No longer shown: its tiles make room when there is need. */
  rest(): void {
    this.tiles.group.visible = false;
    for (const tile of this.state.usedSet) this.tiles.lruCache.markUnused(tile);
  }

  /** Asks once more for what failed. */
  retry(): void {
    for (const { tile, coarser, error } of this.failures) {
      if (coarser) coarser.geometricError = error;
      this.tiles.lruCache.remove(tile); // or it would count as loaded
    }
    this.failures = [];
    this.tiles.resetFailedTiles();
  }

  *visibleTiles(): Generator<VoxelTile> {
    for (const scene of this.tiles.group.children) for (const part of scene.children) if (part instanceof VoxelTile) yield part;
  }

  get isLoading(): boolean {
    const { stats } = this.state;
    return (!this.tiles.root && !this.isFailed) || stats.queued + stats.downloading + stats.parsing > 0 || this.state.processNodeQueue.running;
  }

  get isFailed(): boolean {
    return !this.tiles.root && this.state.rootLoadingState === ROOT_FAILED;
  }

  private get state(): RendererState {
    return this.tiles as unknown as RendererState;
  }

  private voxelPlugin(localFromEcef: Matrix4) {
    return {
      name: 'voxels',
      // The whole tileset in the map's own frame, so that boxes about tiles lie there.
      preprocessNode: (tile: { transform?: number[] }, _folder: string, parent: object | null) => {
        if (parent === null) {
          const transform = tile.transform ? new Matrix4().fromArray(tile.transform) : new Matrix4();
          tile.transform = transform.premultiply(localFromEcef).toArray();
        }
      },
      // For a tileset beside the page 3d-tiles-renderer 0.5 asks for //tiles/...
      preprocessURL: (url: string) => url.replace(/([^:/])\/\/+/g, '$1/'),
      processTileModel: async (scene: Object3D, tile: LoadedTile) => this.replacePoints(scene, tile),
      calculateBytesUsed: (_tile: object, scene: Object3D | null) =>
        scene ? scene.children.reduce((sum, part) => sum + (part instanceof VoxelTile ? part.bytes : 0), 0) : 0,
      disposeTile: (tile: { engineData: { scene: Object3D | null } }) => this.forget(tile.engineData.scene),
    };
  }

  /** Voxels are placed by their numbers, which are exact, not by the tile's transform. */
  private replacePoints(scene: Object3D, tile: LoadedTile): void {
    const content = new URL(tile.content.uri, tile.internal.basePath.replace(/\/?$/, '/'));
    const sources: Points[] = [];
    scene.traverse((part) => {
      if ('isPoints' in part) sources.push(part as Points);
    });
    scene.clear();
    scene.position.set(0, 0, 0);
    scene.quaternion.identity();
    scene.scale.set(1, 1, 1);
    for (const source of sources) {
      const number = this.freeNumber();
      const place = placeOf({ ...source.parent?.userData, ...source.userData }, content, this.hasHistory);
      const voxels = new VoxelTile(source, place, this.shared, number);
      this.byNumber.set(number, voxels);
      voxels.userData.number = number;
      source.geometry.dispose();
      scene.add(voxels);
    }
  }

  /** Below 4095, so that a name of 32 bits holds it beside 20 bits for the voxel. */
  private freeNumber(): number {
    for (let number = 0; number < 4095; ++number) if (!this.byNumber.has(number)) return number;
    throw new Error('more than 4095 tiles at once');
  }

  private forget(scene: Object3D | null): void {
    for (const part of scene?.children ?? []) {
      if (!(part instanceof VoxelTile)) continue;
      if (this.byNumber.get(part.userData.number) === part) this.byNumber.delete(part.userData.number);
      part.dispose();
    }
  }

  private listen(): void {
    for (const type of ['needs-update', 'load-model', 'load-tileset'] as const) this.tiles.addEventListener(type, () => this.events.changed());
    this.tiles.addEventListener('load-error', ({ tile, url }) => this.fail(tile as unknown as FailedTile | null, String(url)));
  }

  /** Where a tile is missing the coarser one stays: rather that than a hole. */
  private fail(tile: FailedTile | null, url: string): void {
    if (tile) {
      const coarser = tile.parent;
      this.failures.push({ tile, coarser, error: coarser?.geometricError ?? 0 });
      if (coarser) coarser.geometricError = 0;
    }
    this.events.failed(url);
  }
}

