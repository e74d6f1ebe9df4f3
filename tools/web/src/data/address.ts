// SPDX-License-Identifier: GPL-3.0-or-later
// A view as the part of the address behind '#': what is shared, bookmarked, and restored by the back button.
import type { Filter } from './spaces.ts';
import type { Vector } from './voxel_id.ts';

export type CameraMode = 'orbit' | 'walk' | 'plan';
export type ColourMode = 'color' | 'height' | 'label' | 'change' | 'age';

export const CAMERA_MODES: readonly CameraMode[] = ['orbit', 'walk', 'plan'];
export const COLOUR_MODES: readonly ColourMode[] = ['color', 'height', 'label', 'change', 'age'];
const FILTERS: readonly Filter[] = ['all', 'occupied', 'vacant', 'unknown', 'changed'];

export interface Pose {
  mode: CameraMode;
  eye: Vector; // [m, map-local]
  target: Vector; // [m, map-local] what it looks at
}

/** All that a shared address restores; undefined: as the page chooses. */
export interface View {
  pose?: Pose;
  colour?: ColourMode;
  epoch?: string;
  before?: string; // the epoch on the left; none: one picture
  split?: number; // 0..1, where the two meet
  filter?: Filter;
  space?: string;
  voxel?: string;
}

const text = (vector: Vector) => vector.map((x) => String(Math.round(x * 100) / 100)).join(',');

function parseVector(value: string | null): Vector | null {
  const numbers = (value ?? '').split(',').map(Number);
  const isVector = value && numbers.length === 3 && numbers.every((x) => Number.isFinite(x) && Math.abs(x) < 1e6);
  return isVector ? [numbers[0], numbers[1], numbers[2]] : null;
}

function oneOf<T extends string>(values: readonly T[], value: string | null): T | undefined {
  return values.find((candidate) => candidate === value);
}

export function writeAddress(view: View): string {
  const fields = new URLSearchParams();
  if (view.pose) {
    fields.set('camera', view.pose.mode);
    fields.set('eye', text(view.pose.eye));
    fields.set('target', text(view.pose.target));
  }
  if (view.colour) fields.set('colour', view.colour);
  if (view.epoch) fields.set('epoch', view.epoch);
  if (view.before) fields.set('before', view.before);
  if (view.before && view.split !== undefined) fields.set('split', view.split.toFixed(3));
  if (view.filter && view.filter !== 'all') fields.set('filter', view.filter);
  if (view.space) fields.set('space', view.space);
  if (view.voxel) fields.set('voxel', view.voxel);
  return `#${fields.toString().replaceAll('%2C', ',')}`;
}

/** Whatever of an address makes sense: it may come from anywhere. */
export function readAddress(address: string): View {
  const fields = new URLSearchParams(address.replace(/^#/, ''));
  const view: View = {};
  const [mode, eye, target] = [oneOf(CAMERA_MODES, fields.get('camera')), parseVector(fields.get('eye')), parseVector(fields.get('target'))];
  if (mode && eye && target) view.pose = { mode, eye, target };
  view.colour = oneOf(COLOUR_MODES, fields.get('colour'));
  view.epoch = fields.get('epoch') ?? undefined;
  view.before = fields.get('before') ?? undefined;
  const split = Number.parseFloat(fields.get('split') ?? '');
  if (split >= 0 && split <= 1) view.split = split;
  view.filter = oneOf(FILTERS, fields.get('filter'));
  view.space = fields.get('space') ?? undefined;
  view.voxel = fields.get('voxel') ?? undefined;
  return view;
}
