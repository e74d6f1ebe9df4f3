// SPDX-License-Identifier: GPL-3.0-or-later
// Where somebody can stand: ground, and room for a person above it.
import type { Vector } from '../data/voxel_id.ts';

const CELL = 0.8; // [m]
const REACH = 25; // [m] how far off one looks for a place
const STEP = 0.5; // [m] above the lowest: still ground
const HEADROOM = 2.1; // [m]

interface Column {
  ground: number;
  heights: number[];
}

function columnsOf(voxels: Iterable<Vector>, [x0, y0]: Vector): Map<string, Column> {
  const columns = new Map<string, Column>();
  for (const [x, y, z] of voxels) {
    if (Math.abs(x - x0) > REACH || Math.abs(y - y0) > REACH) continue;
    const key = `${Math.floor(x / CELL)},${Math.floor(y / CELL)}`;
    const column = columns.get(key);
    if (!column) columns.set(key, { ground: z, heights: [z] });
    else {
      column.ground = Math.min(column.ground, z);
      column.heights.push(z);
    }
  }
  return columns;
}

/** The nearest such place to a point, in the open rather than in a gap; voxels: centres [m]. Null where there is none within 25 m. */
export function standingPlace(voxels: Iterable<Vector>, near: Vector): Vector | null {
  const columns = columnsOf(voxels, near);
  return nearestFree(columns, near, 3) ?? nearestFree(columns, near, 1);
}

/** The nearest column with `margin` free ones on each side. */
function nearestFree(columns: Map<string, Column>, near: Vector, margin: number): Vector | null {
  const around = Array.from({ length: 2 * margin + 1 }, (_, index) => index - margin);
  const isFree = (i: number, j: number, ground: number): boolean => {
    const column = columns.get(`${i},${j}`);
    return column !== undefined && Math.abs(column.ground - ground) < STEP && column.heights.every((z) => z < ground + STEP || z > ground + HEADROOM);
  };
  let best: { place: Vector; distance: number } | null = null;
  for (const [key, { ground }] of columns) {
    const [i, j] = key.split(',').map(Number);
    const place: Vector = [(i + 0.5) * CELL, (j + 0.5) * CELL, ground];
    const distance = Math.hypot(place[0] - near[0], place[1] - near[1]);
    if (best && best.distance <= distance) continue;
    if (around.every((a) => around.every((b) => isFree(i + a, j + b, ground)))) best = { place, distance };
  }
  return best?.place ?? null;
}
