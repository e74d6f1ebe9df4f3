// SPDX-License-Identifier: GPL-3.0-or-later
// Names of voxels, as vdbmap/core/voxel_id.h defines them: 21 bits an axis, x highest, counted from the lowest index.

export type VoxelIndex = readonly [number, number, number];
export type Vector = readonly [number, number, number];

const INDEX_LIMIT = 2 ** 20;
const ID_BITS = 21n;
const AXIS_MASK = (1n << ID_BITS) - 1n;

export function isAddressable(voxel: VoxelIndex): boolean {
  return voxel.every((index) => Number.isInteger(index) && index >= -INDEX_LIMIT && index < INDEX_LIMIT);
}

/** The id of an addressable voxel. */
export function idOfVoxel(voxel: VoxelIndex): bigint {
  return voxel.reduce((id, index) => (id << ID_BITS) | BigInt(index + INDEX_LIMIT), 0n);
}

export function voxelOfId(id: bigint): VoxelIndex {
  const index = (shift: bigint) => Number((id >> shift) & AXIS_MASK) - INDEX_LIMIT;
  return [index(2n * ID_BITS), index(ID_BITS), index(0n)];
}

/** 16 hexadecimal digits, lower case. */
export function textOfId(id: bigint): string {
  return id.toString(16).padStart(16, '0');
}

/** Reads the text form, upper case and a leading 0x too; null where it is not one. */
export function parseVoxelId(text: string): bigint | null {
  const digits = /^(?:0x)?([0-9a-f]{16})$/i.exec(text.trim());
  if (!digits) return null;
  const id = BigInt(`0x${digits[1]}`);
  return id < 1n << (3n * ID_BITS) ? id : null;
}

/** The voxel of `voxelSize` [m] that holds a point [m, map-local]. */
export function voxelOfPoint(point: Vector, voxelSize: number): VoxelIndex {
  // As the map does it: a product, since 0.3 / 0.1 is not 3.
  const voxelsPerMetre = Math.round(1e6 / voxelSize) / 1e6;
  return [
    Math.floor(point[0] * voxelsPerMetre),
    Math.floor(point[1] * voxelsPerMetre),
    Math.floor(point[2] * voxelsPerMetre),
  ];
}

export function centreOfVoxel(voxel: VoxelIndex, voxelSize: number): Vector {
  return [(voxel[0] + 0.5) * voxelSize, (voxel[1] + 0.5) * voxelSize, (voxel[2] + 0.5) * voxelSize];
}
