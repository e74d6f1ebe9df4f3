// SPDX-License-Identifier: GPL-3.0-or-later
// The points of a tile as something to draw and to pick from.
import {
  BufferAttribute, BufferGeometry, DataTexture, DoubleSide, GLSL3, Group, Mesh, NearestFilter, Points, RawShaderMaterial, RGBAIntegerFormat,
  RGIntegerFormat, Sphere, UnsignedIntType, Vector3, Vector4,
  type Camera, type IUniform, type InterleavedBufferAttribute, type Object3D, type OrthographicCamera, type PerspectiveCamera,
} from 'three';
import type { VoxelIndex } from '../data/voxel_id.ts';
import { CUBE_FRAGMENT, CUBE_VERTEX, POINT_FRAGMENT, POINT_VERTEX } from './voxel_shaders.ts';

/** Uniforms that all tiles share by reference. */
export type SharedUniforms = Record<'table' | 'colourMode' | 'isPicking' | 'edgeStrength' | 'pixelsPerUnit' | 'heightRange', IUniform>;

const TEXTURE_WIDTH = 2048; // as the shaders have it
const MOST_VOXELS = 2 ** 20; // of a tile: 20 bits of the names in picking
const ALL_FACES = 63;
const VANISHED = 2; // of _CHANGE
const POINT_PIXELS = 3; // cubes smaller than this are drawn as points

/** What the shaders need of the seven visible corners of each voxel, shared by all tiles and as long as the largest. */
class CubeIndex {
  private attribute = new BufferAttribute(new Uint32Array(0), 1);

  of(voxels: number): BufferAttribute {
    if (this.attribute.count < 18 * voxels) this.attribute = new BufferAttribute(CubeIndex.build(Math.max(65536, 2 ** Math.ceil(Math.log2(voxels)))), 1);
    return this.attribute;
  }

  private static build(voxels: number): Uint32Array {
    const corners = [0, 2, 6, 0, 6, 3, 0, 3, 5, 0, 5, 1, 0, 1, 4, 0, 4, 2];
    const index = new Uint32Array(18 * voxels);
    for (let voxel = 0, at = 0; voxel < voxels; ++voxel) for (const corner of corners) index[at++] = 8 * voxel + corner;
    return index;
  }
}
const cubeIndex = new CubeIndex();

type Attribute = BufferAttribute | InterleavedBufferAttribute | undefined;

/** Component `component` of point `i` as it stands in the file. */
function byteOf(attribute: Attribute, i: number, component = 0): number {
  if (!attribute) return 0;
  if ('isInterleavedBufferAttribute' in attribute && attribute.isInterleavedBufferAttribute) {
    return attribute.data.array[i * attribute.data.stride + attribute.offset + component] as number;
  }
  return (attribute as BufferAttribute).array[i * attribute.itemSize + component] as number;
}

/** Two words a voxel, four where the map knows changes or ages (voxel_shaders.ts). */
function packVoxels(geometry: BufferGeometry, hasHistory: boolean): { words: Uint32Array; stride: 2 | 4 } {
  const get = (name: string) => geometry.getAttribute(name) as Attribute;
  const [position, color, voxel] = ['position', 'color', '_voxel'].map(get); // _VOXEL: code of the class, change, faces, age
  const count = position!.count;
  const stride = hasHistory ? 4 : 2;
  const rows = Math.ceil(count / TEXTURE_WIDTH);
  const words = new Uint32Array(stride * TEXTURE_WIDTH * rows);
  for (let i = 0; i < count; ++i) {
    const [red, green, blue] = color ? [byteOf(color, i), byteOf(color, i, 1), byteOf(color, i, 2)] : [140, 140, 140];
    words[stride * i] = byteOf(position, i) | (byteOf(position, i, 1) << 8) | (byteOf(position, i, 2) << 16) | ((voxel ? byteOf(voxel, i, 2) : ALL_FACES) << 24);
    words[stride * i + 1] = red | (green << 8) | (blue << 16) | (byteOf(voxel, i, 0) << 24);
    if (stride === 4) words[4 * i + 2] = byteOf(voxel, i, 1) | (byteOf(voxel, i, 3) << 8);
  }
  return { words, stride };
}

function textureOf(words: Uint32Array, stride: 2 | 4): DataTexture {
  const texture = new DataTexture(words, TEXTURE_WIDTH, words.length / stride / TEXTURE_WIDTH, stride === 4 ? RGBAIntegerFormat : RGIntegerFormat, UnsignedIntType);
  texture.internalFormat = stride === 4 ? 'RGBA32UI' : 'RG32UI';
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** What a tile's content says of where its points lie in the map, and what is known beside it. */
export interface TilePlace {
  voxelSize: number; // [m]
  minIndex: VoxelIndex; // of the voxel at 0 0 0
  details: string | null; // URL of the records of the finest level
  firstDetail: number;
  hasHistory: boolean; // whether changes and ages mean anything
}

/** From a node's extras and the URL of its tile; throws where they do not say. */
export function placeOf(extras: { voxel_size?: number; min_index?: [number, number, number]; first_detail?: number; details?: string }, url: URL, hasHistory: boolean): TilePlace {
  if (!extras.voxel_size || !extras.min_index) throw new Error('a tile does not say where its voxels lie (voxel_size, min_index)');
  const details = extras.details ? new URL(extras.details, url).href : null;
  return { voxelSize: extras.voxel_size, minIndex: extras.min_index, details, firstDetail: extras.first_detail ?? 0, hasHistory };
}

/** One primitive of a tile's content, placed in map-local metres by the numbers of its voxels. */
export class VoxelTile extends Group {
  readonly voxelSize: number; // [m]
  readonly minIndex: VoxelIndex;
  readonly count: number;
  readonly details: string | null; // URL of the records
  readonly firstDetail: number;
  readonly bytes: number; // on either side of the bus
  private readonly words: Uint32Array;
  private readonly stride: 2 | 4;
  private readonly texture: DataTexture;
  private readonly cubes: Mesh;
  private readonly points: Points;
  private readonly eyeInTile = { value: new Vector4() };
  private readonly sphere: Sphere;

  constructor(source: Points, place: TilePlace, shared: SharedUniforms, tileNumber: number) {
    super();
    ({ voxelSize: this.voxelSize, minIndex: this.minIndex, details: this.details, firstDetail: this.firstDetail } = place);
    const { geometry } = source;
    this.count = geometry.getAttribute('position').count;
    if (this.count > MOST_VOXELS) throw new Error(`a tile holds ${this.count} voxels; this page draws up to ${MOST_VOXELS}`);
    ({ words: this.words, stride: this.stride } = packVoxels(geometry, place.hasHistory));
    this.texture = textureOf(this.words, this.stride);
    this.bytes = 2 * this.words.byteLength;
    geometry.computeBoundingSphere();
    this.sphere = geometry.boundingSphere!.clone();
    this.sphere.radius += 1;
    const uniforms = { ...shared, voxels: { value: this.texture }, tileNumber: { value: tileNumber }, eyeInTile: this.eyeInTile, voxelSize: { value: this.voxelSize } };
    this.cubes = this.makeCubes(uniforms);
    this.points = this.makePoints(uniforms);
    this.add(this.cubes, this.points);
    this.place();
  }

  /** A voxel's index on its level. */
  voxelAt(point: number): VoxelIndex {
    const word = this.words[this.stride * point];
    return [this.minIndex[0] + (word & 255), this.minIndex[1] + ((word >> 8) & 255), this.minIndex[2] + ((word >> 16) & 255)];
  }

  /** Code of the class (site.json). */
  labelAt(point: number): number {
    return this.words[this.stride * point + 1] >>> 24;
  }

  changeAt(point: number): number {
    return this.stride === 4 ? this.words[4 * point + 2] & 255 : 0;
  }

  /** The number of the point at a voxel; null where there is none. */
  pointOf(voxel: VoxelIndex): number | null {
    const inTile = voxel.map((index, axis) => index - this.minIndex[axis]);
    if (inTile.some((index) => index < 0 || index > 255)) return null;
    const word = inTile[0] | (inTile[1] << 8) | (inTile[2] << 16);
    for (let i = 0; i < this.count; ++i) if ((this.words[this.stride * i] & 0xffffff) === word) return i;
    return null;
  }

  /** Height of the top of the highest voxel in a column that lies wholly below `limit` [m, map-local]; null where there is none. */
  topBelow(x: number, y: number, limit: number): number | null {
    const column = [x, y].map((value, axis) => Math.floor(value / this.voxelSize) - this.minIndex[axis]);
    if (column.some((index) => index < 0 || index > 255)) return null;
    const word = column[0] | (column[1] << 8);
    let highest: number | null = null;
    for (let i = 0; i < this.count; ++i) {
      const packed = this.words[this.stride * i];
      if ((packed & 0xffff) !== word || this.changeAt(i) === VANISHED) continue;
      const top = (this.minIndex[2] + ((packed >> 16) & 255) + 1) * this.voxelSize;
      if (top <= limit && (highest === null || top > highest)) highest = top;
    }
    return highest;
  }

  /** Before each frame: cubes where they are large enough to be seen as such. */
  chooseShape(camera: PerspectiveCamera | OrthographicCamera, pixelsPerUnit: number): void {
    const eye = camera.getWorldPosition(new Vector3());
    const centre = this.sphere.center.clone().applyMatrix4(this.matrixWorld);
    const isParallel = 'isOrthographicCamera' in camera;
    const distance = isParallel ? 1 : Math.max(eye.distanceTo(centre) - this.sphere.radius * this.voxelSize, 0.1);
    const isLarge = (this.voxelSize * pixelsPerUnit) / distance > POINT_PIXELS;
    this.cubes.visible = isLarge;
    this.points.visible = !isLarge;
  }

  dispose(): void {
    this.texture.dispose();
    this.cubes.geometry.setIndex(null); // others go on with it
    for (const part of [this.cubes, this.points]) {
      part.geometry.dispose();
      (part.material as RawShaderMaterial).dispose();
    }
  }

  private place(): void {
    this.matrixAutoUpdate = false;
    const at = this.minIndex.map((index) => (index + 0.5) * this.voxelSize);
    this.matrix.makeScale(this.voxelSize, this.voxelSize, this.voxelSize).setPosition(at[0], at[1], at[2]);
  }

  /** What draws cubes and points, for compiling it before there is a tile. */
  static prototypes(shared: SharedUniforms): Object3D[] {
    const source = new Points(new BufferGeometry().setAttribute('position', new BufferAttribute(new Uint8Array(3), 3)));
    return [...new VoxelTile(source, { voxelSize: 1, minIndex: [0, 0, 0], details: null, firstDetail: 0, hasHistory: true }, shared, 0).children];
  }

  private makeCubes(uniforms: Record<string, IUniform>): Mesh {
    const geometry = new BufferGeometry();
    geometry.setIndex(cubeIndex.of(this.count));
    geometry.setDrawRange(0, 18 * this.count);
    geometry.boundingSphere = this.sphere;
    const material = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: CUBE_VERTEX, fragmentShader: CUBE_FRAGMENT, uniforms, side: DoubleSide });
    const mesh = new Mesh(geometry, material);
    mesh.onBeforeRender = (_renderer, _scene, camera) => this.setEye(camera);
    return mesh;
  }

  private makePoints(uniforms: Record<string, IUniform>): Points {
    const geometry = new BufferGeometry();
    geometry.setDrawRange(0, this.count);
    geometry.boundingSphere = this.sphere;
    const material = new RawShaderMaterial({ glslVersion: GLSL3, vertexShader: POINT_VERTEX, fragmentShader: POINT_FRAGMENT, uniforms });
    const points = new Points(geometry, material);
    points.onBeforeRender = (_renderer, _scene, camera) => this.setEye(camera);
    return points;
  }

  private setEye(camera: Camera): void {
    const inverse = this.matrixWorld.clone().invert();
    if ('isOrthographicCamera' in camera) {
      const towards = new Vector3().setFromMatrixColumn(camera.matrixWorld, 2);
      this.eyeInTile.value.set(towards.x, towards.y, towards.z, 0);
    } else {
      const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld).applyMatrix4(inverse);
      this.eyeInTile.value.set(eye.x, eye.y, eye.z, 1);
    }
  }
}
