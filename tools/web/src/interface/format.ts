// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as people read them.
import type { Epoch } from '../data/site.ts';
import type { Vector } from '../data/voxel_id.ts';

const whole = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });

export function formatCount(value: number): string {
  return whole.format(value).replaceAll(',', ' '); // narrow no-break space
}

export function formatMetres(metres: number): string {
  const size = Math.abs(metres);
  if (size < 10) return `${metres.toFixed(2)} m`;
  return size < 1000 ? `${metres.toFixed(1)} m` : `${(metres / 1000).toFixed(2)} km`;
}

export function formatVector(vector: Vector, decimals = 2): string {
  return vector.map((x) => x.toFixed(decimals)).join('  ');
}

export function formatPercent(share: number): string {
  return `${Math.round(share * 100)} %`;
}

export function formatDate(date: string): string {
  const parsed = new Date(`${date}T00:00:00Z`);
  return Number.isNaN(parsed.getTime()) ? date : parsed.toLocaleDateString('en-GB', { day: 'numeric', month: 'long', year: 'numeric', timeZone: 'UTC' });
}

/** What an epoch is called: its date in words where its name is only that. */
export function epochName({ name, date }: Epoch): string {
  return date !== null && name === date ? formatDate(date) : name;
}

export function plural(number: number, one: string, many = `${one}s`): string {
  return `${formatCount(number)} ${number === 1 ? one : many}`;
}

export const STATE_NAMES = { occupied: 'Occupied', vacant: 'Vacant', unknown: 'Unknown' } as const;
