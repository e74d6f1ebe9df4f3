// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of voxels and spaces: one table that the shaders read and the legends show.
import { DataTexture, NearestFilter, RGBAFormat, UnsignedByteType } from 'three';
import type { ColourMode } from '../data/address.ts';
import type { LabelClass } from '../data/site.ts';
import type { State } from '../data/spaces.ts';

export type Rgb = readonly [number, number, number]; // 0..255, sRGB

export const STATE_COLOURS: Record<State, Rgb> = { occupied: [214, 57, 57], vacant: [34, 153, 84], unknown: [130, 138, 148] };

/** Values of _CHANGE; that of 0, no change, is the voxel's own colour, paler. */
export const CHANGES: readonly { value: number; name: string; colour: Rgb }[] = [
  { value: 1, name: 'Appeared', colour: [38, 120, 214] },
  { value: 2, name: 'Vanished', colour: [222, 84, 36] },
  { value: 3, name: 'Changed', colour: [232, 178, 44] },
  { value: 4, name: 'Not seen this time', colour: [150, 132, 176] },
];

/** Rows of the table. */
export const ROWS: Record<Exclude<ColourMode, 'color'>, number> = { height: 0, label: 1, change: 2, age: 3 };

// Low to high; even in lightness, and told apart without red and green (after viridis and its kin).
const HEIGHT_STOPS: readonly Rgb[] = [[48, 44, 110], [40, 100, 142], [42, 150, 138], [112, 194, 96], [222, 214, 74], [252, 240, 170]];
const AGE_STOPS: readonly Rgb[] = [[86, 60, 122], [176, 74, 110], [238, 136, 86], [250, 220, 140]];
const NO_CLASS: Rgb = [156, 160, 166];

export function css(colour: Rgb): string {
  return `rgb(${colour.map(Math.round).join(' ')})`;
}

/** Between the stops, at 0..1. */
function alongRamp(stops: readonly Rgb[], at: number): Rgb {
  const position = Math.min(Math.max(at, 0), 1) * (stops.length - 1);
  const index = Math.min(Math.floor(position), stops.length - 2);
  const share = position - index;
  const mix = (channel: number) => stops[index][channel] * (1 - share) + stops[index + 1][channel] * share;
  return [mix(0), mix(1), mix(2)];
}

export function heightColour(at: number): Rgb {
  return alongRamp(HEIGHT_STOPS, at);
}

/** Of how many epochs ago a voxel was last seen: what the newest saw is the lightest. */
export function ageColour(epochsAgo: number, epochs: number): Rgb {
  return alongRamp(AGE_STOPS, epochs > 1 ? 1 - epochsAgo / (epochs - 1) : 1);
}

/** 256 columns, a row for each way of colouring but the voxel's own colour. */
export function colourTable(labels: readonly LabelClass[], epochs: number): DataTexture {
  const bytes = new Uint8Array(256 * 4 * 4);
  const put = (row: number, column: number, colour: Rgb) => bytes.set([...colour, 255], 4 * (256 * row + column));
  for (let i = 0; i < 256; ++i) {
    put(ROWS.height, i, heightColour(i / 255));
    put(ROWS.label, i, NO_CLASS);
    put(ROWS.age, i, ageColour(Math.min(i, epochs - 1), epochs));
  }
  for (const { code, color } of labels) if (code >= 0 && code < 256) put(ROWS.label, code, color);
  for (const { value, colour } of CHANGES) put(ROWS.change, value, colour);
  const table = new DataTexture(bytes, 256, 4, RGBAFormat, UnsignedByteType);
  table.minFilter = table.magFilter = NearestFilter;
  table.needsUpdate = true;
  return table;
}
