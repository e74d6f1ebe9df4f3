// SPDX-License-Identifier: GPL-3.0-or-later
// site.json: what the folder beside the page holds. `vdbmap web` writes it (tools/web/README.md has its fields).
import type { Vector } from './voxel_id.ts';

export interface Epoch {
  id: string;
  name: string;
  date: string | null;
  tileset: string; // URL relative to the page
  voxels: number; // of the finest level
  points: number; // measured points in them
}

export interface LabelClass {
  code: number; // in tiles and details
  value: number; // of the map's label scheme
  name: string;
  color: [number, number, number]; // 0..255, sRGB
}

export interface Site {
  name: string;
  epsg: number | null; // null: local coordinates
  anchor: Vector; // [m] original coordinates = anchor + map-local ones
  bounds: { min: Vector; max: Vector }; // [m, map-local]
  voxelSize: number; // [m] of the finest level
  localFromEcef: number[]; // column-major
  geoidOffset: number; // [m] ellipsoidal height = height + offset
  epochs: Epoch[]; // oldest first
  attributes: { color: boolean; label: boolean; change: boolean; epoch: boolean };
  labels: LabelClass[];
  spaces: string | null; // URL relative to the page
  attribution: string | null;
}

/** A site's file that cannot be used; the message is for the person who looks at the page. */
export class SiteError extends Error {}

function isVector(value: unknown): value is Vector {
  return Array.isArray(value) && value.length === 3 && value.every((x) => Number.isFinite(x));
}

function readEpochs(value: unknown): Epoch[] {
  if (!Array.isArray(value)) throw new SiteError('site.json: no list of epochs');
  return value.map((epoch, index) => {
    if (typeof epoch?.tileset !== 'string') throw new SiteError(`site.json: epoch ${index + 1} has no tileset`);
    const id = String(epoch.id ?? index + 1);
    return {
      id,
      name: String(epoch.name ?? id),
      date: epoch.date ?? null,
      tileset: epoch.tileset,
      voxels: Number(epoch.voxels ?? 0),
      points: Number(epoch.points ?? 0),
    };
  });
}

/** The site that site.json describes; throws SiteError where a needed field is missing. */
export function readSite(json: any): Site {
  if (json?.format !== 'vdbmap-site') throw new SiteError('site.json is not a site of vdbmap');
  if (json.version !== 1) throw new SiteError(`site.json has version ${json.version}; this page reads version 1`);
  const epochs = readEpochs(json.epochs);
  const hasBounds = isVector(json.bounds?.min) && isVector(json.bounds?.max);
  return {
    name: String(json.name ?? 'Map'),
    epsg: json.epsg ?? null,
    anchor: isVector(json.anchor) ? json.anchor : [0, 0, 0],
    bounds: hasBounds ? { min: json.bounds.min, max: json.bounds.max } : { min: [0, 0, 0], max: [0, 0, 0] },
    voxelSize: json.voxel_size > 0 ? json.voxel_size : 0.1,
    localFromEcef: json.local_from_ecef?.length === 16 ? json.local_from_ecef : [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
    geoidOffset: Number(json.geoid_offset ?? 0),
    epochs,
    attributes: { color: false, label: false, change: false, epoch: false, ...json.attributes },
    labels: Array.isArray(json.labels) ? json.labels : [],
    spaces: json.spaces ?? null,
    attribution: json.attribution ?? null,
  };
}

export function isEmpty(site: Site): boolean {
  return site.epochs.every((epoch) => epoch.voxels === 0);
}
