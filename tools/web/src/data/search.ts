// SPDX-License-Identifier: GPL-3.0-or-later
// What a person may type into the search field: a space, a voxel, or a place.
import { localOfGeographic } from './geodesy.ts';
import type { Site } from './site.ts';
import type { Space } from './spaces.ts';
import { centreOfVoxel, parseVoxelId, voxelOfId, type Vector } from './voxel_id.ts';

export type Found =
  | { kind: 'space'; space: Space }
  | { kind: 'voxel'; id: bigint; point: Vector }
  | { kind: 'place'; point: Vector; as: 'map' | 'local' | 'geographic' }
  | { kind: 'outside' } // a place, but not one of this map
  | { kind: 'nothing' };

const MARGIN = 50; // [m] about the map within which a place still counts as of it

function isInside(point: Vector, { bounds }: Site): boolean {
  return [0, 1].every((axis) => point[axis] >= bounds.min[axis] - MARGIN && point[axis] <= bounds.max[axis] + MARGIN);
}

/** Two or three numbers, apart by spaces, commas or semicolons; null where the text is anything else. */
export function parseNumbers(text: string): number[] | null {
  const parts = text.trim().split(/\s*[,;]\s*|\s+/).filter((part) => part !== '');
  const numbers = parts.map((part) => Number(part.replace(/[°mNE]$/, '')));
  return (numbers.length === 2 || numbers.length === 3) && numbers.every(Number.isFinite) ? numbers : null;
}

function findPlace(numbers: number[], site: Site): Found {
  const [a, b] = numbers;
  const ground = site.bounds.min[2];
  const asMap: Vector = [a - site.anchor[0], b - site.anchor[1], (numbers[2] ?? ground + site.anchor[2]) - site.anchor[2]];
  if (isInside(asMap, site)) return { kind: 'place', point: asMap, as: 'map' };
  if (site.epsg !== null && Math.abs(a) <= 90 && Math.abs(b) <= 180) {
    const [x, y] = localOfGeographic({ latitude: a, longitude: b, height: site.anchor[2] + site.geoidOffset }, site.localFromEcef);
    if (isInside([x, y, ground], site)) return { kind: 'place', point: [x, y, ground], as: 'geographic' };
  }
  const asLocal: Vector = [a, b, numbers[2] ?? ground];
  if (isInside(asLocal, site)) return { kind: 'place', point: asLocal, as: 'local' };
  return { kind: 'outside' };
}

/** A space's id before a voxel's, and that before coordinates: the map's own, latitude and longitude, or map-local ones. */
export function search(text: string, site: Site, spaces: readonly Space[]): Found {
  const query = text.trim().toLowerCase();
  if (query === '') return { kind: 'nothing' };
  const space = spaces.find((candidate) => candidate.id.toLowerCase() === query);
  if (space) return { kind: 'space', space };
  const id = parseVoxelId(query);
  if (id !== null) {
    const point = centreOfVoxel(voxelOfId(id), site.voxelSize);
    return isInside(point, site) ? { kind: 'voxel', id, point } : { kind: 'outside' };
  }
  const numbers = parseNumbers(query);
  return numbers ? findPlace(numbers, site) : { kind: 'nothing' };
}
