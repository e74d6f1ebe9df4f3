// SPDX-License-Identifier: GPL-3.0-or-later
// Where a map is worth looking at: most of it, seen along its longer axis. Rays that strayed far off do not count.
import type { Pose } from './address.ts';
import type { Vector } from './voxel_id.ts';

export interface Overview {
  centre: Vector; // [m, map-local] on the ground
  axis: number; // [rad] of the longer side, counter-clockwise from east
  length: number; // [m]
  width: number; // [m]
}

const SHARE_LEFT_OUT = 0.08; // at each end

/** Value below which a share of the values lies. */
function quantile(values: readonly number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)];
}

/** Main axis of the points' second moments in plan [rad]. */
function mainAxis(points: readonly Vector[], [x0, y0]: readonly [number, number]): number {
  let [xx, xy, yy] = [0, 0, 0];
  for (const [x, y] of points) {
    xx += (x - x0) ** 2;
    xy += (x - x0) * (y - y0);
    yy += (y - y0) ** 2;
  }
  return 0.5 * Math.atan2(2 * xy, xx - yy);
}

/** Of one point or more. */
export function overviewOf(points: readonly Vector[]): Overview {
  const middle: [number, number] = [quantile(points.map(([x]) => x), 0.5), quantile(points.map(([, y]) => y), 0.5)];
  const axis = mainAxis(points, middle);
  const [cos, sin] = [Math.cos(axis), Math.sin(axis)];
  const span = (values: number[]) => [quantile(values, SHARE_LEFT_OUT), quantile(values, 1 - SHARE_LEFT_OUT)];
  const [low, high] = span(points.map(([x, y]) => x * cos + y * sin));
  const [right, left] = span(points.map(([x, y]) => y * cos - x * sin));
  const [along, across] = [(low + high) / 2, (right + left) / 2];
  const ground = quantile(points.map(([, , z]) => z), 0.1);
  return { centre: [along * cos - across * sin, along * sin + across * cos, ground], axis, length: high - low, width: left - right };
}

/** From one end of the street, above the roofs; aspect: width by height of the picture. */
export function overviewPose({ centre, axis, length, width }: Overview, aspect: number): Pose {
  const distance = Math.max(0.7 * length + 0.5 * width, 12) / Math.min(Math.max(aspect, 0.5) / 1.5, 1);
  const angle = axis + (Math.cos(axis) < 0 ? Math.PI : 0) + 0.38; // [rad] looking eastwards, a little from the side
  const level = 0.74 * distance;
  return { mode: 'orbit', target: centre, eye: [centre[0] - level * Math.cos(angle), centre[1] - level * Math.sin(angle), centre[2] + 0.62 * distance] };
}
