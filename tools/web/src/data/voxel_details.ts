// SPDX-License-Identifier: GPL-3.0-or-later
// What a tile leaves out for its size and a picked voxel needs: records of 44 bytes, in the order of the tile's points.
import type { Vector } from './voxel_id.ts';

export const DETAIL_BYTES = 44;

export interface VoxelDetails {
  count: number; // points
  mean: Vector; // [m] from the voxel's low corner
  covariance: [number, number, number, number, number, number]; // [m^2] xx yy zz xy xz yz
  label: number; // code of the class (site.json)
  normal: Vector | null; // null where none could be told
}

/** Reads one record (little endian); throws RangeError where the bytes end before it does. */
export function readDetails(bytes: ArrayBuffer, offset = 0): VoxelDetails {
  const view = new DataView(bytes, offset, DETAIL_BYTES);
  const float = (index: number) => view.getFloat32(4 + 4 * index, true);
  const normal: Vector = [view.getInt8(41) / 127, view.getInt8(42) / 127, view.getInt8(43) / 127];
  return {
    count: view.getUint32(0, true),
    mean: [float(0), float(1), float(2)],
    covariance: [float(3), float(4), float(5), float(6), float(7), float(8)],
    label: view.getUint8(40),
    normal: normal.every((component) => component === 0) ? null : normal,
  };
}

/** Fetches the record of one point; a server that does not know ranges sends the whole file, of which it is cut. */
export async function fetchDetails(url: string, record: number): Promise<VoxelDetails> {
  const first = record * DETAIL_BYTES;
  const response = await fetch(url, { headers: { Range: `bytes=${first}-${first + DETAIL_BYTES - 1}` } });
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  const bytes = await response.arrayBuffer();
  return readDetails(bytes, response.status === 206 ? 0 : first);
}
