// SPDX-License-Identifier: GPL-3.0-or-later
// What a small picture of the names of voxels says of the place in its middle.
import { Vector3, type Ray } from 'three';
import { centreOfVoxel, type Vector, type VoxelIndex } from '../data/voxel_id.ts';

export const PICK_REACH = 7; // [CSS pixels] about the pointer: a point is drawn only where its middle is inside
export const PICK_SIDE = 2 * PICK_REACH + 1;
export const NO_VOXEL = 0xffffffff;
const FORGIVENESS = 3; // [CSS pixels] a click may miss by

/** The name nearest to the middle of a picture of names, or near it. */
export function nameInMiddle(bytes: Uint8Array): number {
  const names = new DataView(bytes.buffer);
  let best = { name: NO_VOXEL, distance: FORGIVENESS + 0.5 };
  for (let row = 0; row < PICK_SIDE; ++row) {
    for (let column = 0; column < PICK_SIDE; ++column) {
      const name = names.getUint32(4 * (row * PICK_SIDE + column), true);
      const distance = Math.hypot(row - PICK_REACH, column - PICK_REACH);
      if (name !== NO_VOXEL && distance < best.distance) best = { name, distance };
    }
  }
  return best.name;
}

/** Where a ray enters a voxel; its centre where rounding says that it misses. */
export function surfaceOf(voxel: VoxelIndex, voxelSize: number, ray: Ray): Vector {
  const centre = new Vector3(...centreOfVoxel(voxel, voxelSize));
  let [enter, leave] = [-Infinity, Infinity];
  for (const axis of ['x', 'y', 'z'] as const) {
    const [a, b] = [-0.5, 0.5].map((half) => (centre[axis] + half * voxelSize - ray.origin[axis]) / ray.direction[axis]);
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave && Number.isFinite(enter) ? ray.at(enter, new Vector3()).toArray() : centre.toArray();
}
