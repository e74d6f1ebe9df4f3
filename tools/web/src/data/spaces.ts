// SPDX-License-Identifier: GPL-3.0-or-later
// Parking spaces and what each epoch says of them (spaces.json).
import { SiteError, type Site } from './site.ts';
import type { Vector } from './voxel_id.ts';

export type State = 'occupied' | 'vacant' | 'unknown';
export const STATES: readonly State[] = ['occupied', 'vacant', 'unknown'];

/** What was found out about a space in one epoch. */
export interface Finding {
  epoch: string;
  state: State;
  confidence: number | null; // 0..1
  vehiclePoints: number | null; // points of vehicles inside
  raysThrough: number | null; // rays that passed through it
}

export interface Space {
  id: string;
  polygon: Vector[]; // [m, map-local] counter-clockwise, z is the ground
  height: number; // [m]
  length: number | null; // [m]
  width: number | null; // [m]
  headingDeg: number | null; // clockwise from north
  kerbSide: string | null; // N, E, S, W or words
  isCandidate: boolean; // free kerb on which nobody was seen to park
  findings: Finding[];
}

export interface Turnover {
  changes: number; // between epochs whose states are both known
  known: number; // epochs with a known state
}

export type Filter = State | 'all' | 'changed';

function numberOrNull(value: unknown): number | null {
  return typeof value === 'number' && Number.isFinite(value) ? value : null;
}

function readFinding(json: any): Finding {
  return {
    epoch: String(json.epoch),
    state: STATES.includes(json.state) ? json.state : 'unknown',
    confidence: numberOrNull(json.confidence),
    vehiclePoints: numberOrNull(json.vehicle_points),
    raysThrough: numberOrNull(json.rays_through),
  };
}

function readPolygon(space: any): Vector[] {
  const { polygon } = space;
  const isCorner = (corner: unknown) => Array.isArray(corner) && corner.length === 3 && corner.every((x) => Number.isFinite(x));
  if (!Array.isArray(polygon) || polygon.length < 3 || !polygon.every(isCorner)) throw new SiteError(`spaces.json: space ${space.id} has no polygon of three corners or more`);
  return polygon;
}

/** The spaces of spaces.json; throws SiteError where it holds none. */
export function readSpaces(json: any): Space[] {
  if (!Array.isArray(json?.spaces)) throw new SiteError('spaces.json: no list of spaces');
  return json.spaces.map((space: any) => ({
    id: String(space.id),
    polygon: readPolygon(space),
    height: space.height > 0 ? space.height : 1.6,
    length: numberOrNull(space.length),
    width: numberOrNull(space.width),
    headingDeg: numberOrNull(space.heading_deg),
    kerbSide: space.kerb_side ?? null,
    isCandidate: space.candidate === true,
    findings: (space.states ?? []).map(readFinding),
  }));
}

export function findingAt(space: Space, epoch: string): Finding | null {
  return space.findings.find((finding) => finding.epoch === epoch) ?? null;
}

/** A space of which an epoch says nothing is unknown there. */
export function stateAt(space: Space, epoch: string): State {
  return findingAt(space, epoch)?.state ?? 'unknown';
}

/** The state in the epoch before, null in the first. */
export function stateBefore(space: Space, epoch: string, epochs: readonly string[]): State | null {
  const index = epochs.indexOf(epoch);
  return index > 0 ? stateAt(space, epochs[index - 1]) : null;
}

/** Whether the epoch shows it taken where the one before showed it free, or the other way round. */
export function isNew(space: Space, epoch: string, epochs: readonly string[]): boolean {
  const before = stateBefore(space, epoch, epochs);
  const now = stateAt(space, epoch);
  return before !== null && before !== 'unknown' && now !== 'unknown' && before !== now;
}

export function matches(space: Space, filter: Filter, epoch: string, epochs: readonly string[]): boolean {
  if (filter === 'all') return true;
  if (filter === 'changed') return isNew(space, epoch, epochs);
  return stateAt(space, epoch) === filter;
}

export function count(spaces: readonly Space[], filter: Filter, epoch: string, epochs: readonly string[]): number {
  return spaces.filter((space) => matches(space, filter, epoch, epochs)).length;
}

/** How often a space went from taken to free or back; epochs that do not know are passed over. */
export function turnover(space: Space, epochs: readonly string[]): Turnover {
  const known = epochs.map((epoch) => stateAt(space, epoch)).filter((state) => state !== 'unknown');
  const changes = known.filter((state, index) => index > 0 && state !== known[index - 1]).length;
  return { changes, known: known.length };
}

/** Middle of the polygon, on the ground [m, map-local]. */
export function centreOf(space: Space): Vector {
  const mean = (axis: number) => space.polygon.reduce((sum, corner) => sum + corner[axis], 0) / space.polygon.length;
  return [mean(0), mean(1), mean(2)];
}

/** Whether none of the spaces lies near the map: they are those of another place. */
export function areElsewhere(spaces: readonly Space[], site: Site, margin = 50): boolean {
  const { min, max } = site.bounds;
  return spaces.length > 0 && spaces.every((space) => {
    const centre = centreOf(space);
    return [0, 1].some((axis) => centre[axis] < min[axis] - margin || centre[axis] > max[axis] + margin);
  });
}

const ROW_LENGTH = 20; // [m] how far off spaces are still of one row
const ROW_WIDTH = 2.5; // [m] how far beside its axis

/** Which way the row of spaces runs about one of them [rad, counter-clockwise from east]: along its longer side, or across where others stand beside it. */
export function directionOfRow(space: Space, spaces: readonly Space[]): number {
  const [x0, y0] = centreOf(space);
  const sides = space.polygon.map(([x, y], i) => [space.polygon[(i + 1) % space.polygon.length][0] - x, space.polygon[(i + 1) % space.polygon.length][1] - y]);
  const longest = sides.reduce((best, side) => (Math.hypot(...side) > Math.hypot(...best) ? side : best));
  const angle = Math.atan2(longest[1], longest[0]);
  const inRow = (axis: number) => spaces.map(centreOf).filter(([x, y]) => {
    const along = (x - x0) * Math.cos(axis) + (y - y0) * Math.sin(axis);
    const beside = (y - y0) * Math.cos(axis) - (x - x0) * Math.sin(axis);
    return Math.abs(along) < ROW_LENGTH && Math.abs(beside) < ROW_WIDTH;
  }).length;
  return inRow(angle + Math.PI / 2) > inRow(angle) ? angle + Math.PI / 2 : angle;
}
