// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of what was picked: a space, a voxel, a distance.
import { geographicOfLocal } from '../data/geodesy.ts';
import type { Epoch, Site } from '../data/site.ts';
import { findingAt, isNew, stateAt, stateBefore, turnover, type Finding, type Space } from '../data/spaces.ts';
import type { VoxelDetails } from '../data/voxel_details.ts';
import { centreOfVoxel, idOfVoxel, textOfId, type Vector, type VoxelIndex } from '../data/voxel_id.ts';
import { CHANGES } from '../scene/colours.ts';
import { h, iconButton, replaceContent } from './dom.ts';
import { epochName, formatCount, formatMetres, formatPercent, formatVector, plural, STATE_NAMES } from './format.ts';
import { stateMark } from './side_panel.ts';

export interface PickedVoxel {
  voxel: VoxelIndex;
  voxelSize: number; // [m]
  label: number; // code of the class
  change: number;
  details: VoxelDetails | 'coarse' | 'loading' | 'failed'; // coarse: of a level without details
}

type Row = [name: string, value: string | Node] | null;

function table(rows: Row[]): HTMLElement {
  const shown = rows.filter((row): row is [string, string | Node] => row !== null);
  return h('dl', {}, ...shown.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)]));
}

/** The survey that the spaces were found in says what stood there, without counts. */
function hasEvidence(finding: Finding): boolean {
  return (finding.vehiclePoints ?? 0) > 0 || (finding.raysThrough ?? 0) > 0;
}

const KERBS: Record<string, string> = { N: 'north', E: 'east', S: 'south', W: 'west' };

function evidence(finding: Finding | null): string {
  if (!finding || finding.state === 'unknown') return 'Hidden, or not seen well enough';
  if (!hasEvidence(finding)) return finding.state === 'occupied' ? 'A vehicle stands in it' : 'Nothing stands in it';
  if (finding.state === 'occupied') return finding.vehiclePoints === null ? 'A vehicle stands in it' : `${plural(finding.vehiclePoints, 'point')} of a vehicle inside`;
  return finding.raysThrough === null ? 'The scanner looked through it' : `${plural(finding.raysThrough, 'ray')} passed through it`;
}

function history(space: Space, epochs: readonly Epoch[], current: string, onEpoch: (id: string) => void): HTMLElement {
  return h('ol', { class: 'history', 'aria-label': 'History' }, ...epochs.map((epoch) => {
    const { id } = epoch;
    const state = stateAt(space, id);
    return h('li', {}, h('button', { type: 'button', 'aria-current': id === current ? 'true' : null, onclick: () => onEpoch(id) }, stateMark(state), h('span', {}, epochName(epoch)), h('span', { class: 'state' }, STATE_NAMES[state])));
  }));
}

export class Card {
  readonly element = h('section', { class: 'card', 'aria-label': 'Details', hidden: true });
  private readonly site: Site;
  private readonly events: { close(): void; epoch(id: string): void; copy(text: string): void };

  constructor(site: Site, events: { close(): void; epoch(id: string): void; copy(text: string): void }) {
    this.site = site;
    this.events = events;
  }

  hide(): void {
    this.element.hidden = true;
  }

  showSpace(space: Space, epoch: string, voxel: PickedVoxel | null): void {
    const epochs = this.site.epochs.map(({ id }) => id);
    const state = stateAt(space, epoch);
    const before = stateBefore(space, epoch, epochs);
    const finding = findingAt(space, epoch);
    const { changes, known } = turnover(space, epochs);
    const size = space.length && space.width ? `${formatMetres(space.length)} × ${formatMetres(space.width)}` : null;
    this.show(`Space ${space.id}`,
      h('p', { class: `verdict ${state}` }, stateMark(state), h('b', {}, STATE_NAMES[state]), isNew(space, epoch, epochs) && h('span', { class: 'new' }, `new: was ${before}`)),
      h('p', {}, evidence(finding)),
      table([
        finding?.confidence == null || !hasEvidence(finding) ? null : ['Confidence', formatPercent(finding.confidence)],
        size ? ['Size', size] : null,
        space.headingDeg === null ? null : ['Heading', `${Math.round(space.headingDeg)}°`],
        space.kerbSide ? ['Kerb', `${KERBS[space.kerbSide] ?? space.kerbSide} side`] : null,
        space.isCandidate ? ['Kind', 'free kerb, long enough for a car'] : null,
        epochs.length > 1 ? ['Turnover', known > 1 ? `${plural(changes, 'change')} in ${plural(known, 'date')}` : 'not known'] : null,
      ]),
      epochs.length > 1 ? h('h3', {}, 'History') : null,
      epochs.length > 1 ? history(space, this.site.epochs, epoch, this.events.epoch) : null,
      voxel ? h('details', {}, h('summary', {}, 'Voxel at this point'), this.voxelTable(voxel)) : null);
  }

  showVoxel(voxel: PickedVoxel): void {
    const size = voxel.voxelSize < 1 ? `${Math.round(voxel.voxelSize * 100)} cm` : formatMetres(voxel.voxelSize);
    this.show(`Voxel of ${size}`, this.voxelTable(voxel));
  }

  showPlace(point: Vector): void {
    this.show('Place', table(this.placeRows(point)));
  }

  showDistance(from: Vector | null, to: Vector | null): void {
    if (!from || !to) {
      this.show('Measure a distance', h('p', {}, from ? 'Choose the second point.' : 'Choose two points in the picture.'));
      return;
    }
    const [dx, dy, dz] = [0, 1, 2].map((axis) => to[axis] - from[axis]);
    this.show('Distance', h('p', { class: 'distance' }, formatMetres(Math.hypot(dx, dy, dz))),
      table([['Level', formatMetres(Math.hypot(dx, dy))], ['Height', formatMetres(dz)]]), h('p', { class: 'quiet' }, 'Choose another point to start anew.'));
  }

  private show(title: string, ...content: (Node | null)[]): void {
    replaceContent(this.element, h('header', {}, h('h2', {}, title), iconButton('close', 'Close details (Esc)', this.events.close)), ...content);
    this.element.hidden = false;
  }

  private voxelTable(picked: PickedVoxel): HTMLElement {
    const { details, voxel, voxelSize } = picked;
    const known = typeof details === 'object' ? details : null;
    const id = textOfId(idOfVoxel(voxel));
    const label = this.site.labels.find(({ code }) => code === picked.label);
    const change = CHANGES.find(({ value }) => value === picked.change);
    const mean = known ? known.mean.map((x, axis) => x + voxel[axis] * voxelSize) as unknown as Vector : null;
    return h('div', {}, table([
      ['Id', h('span', { class: 'id' }, h('code', {}, id), iconButton('copy', 'Copy the voxel id', () => this.events.copy(id)))],
      this.site.attributes.label ? ['Class', label?.name ?? ('not known')] : null,
      change ? ['Change', change.name] : null,
      known ? ['Points', formatCount(known.count)] : null,
      mean ? ['Mean', h('span', { class: 'numbers' }, formatVector(this.original(mean), 3))] : null,
      known ? ['Spread', h('span', { class: 'numbers' }, `${known.covariance.slice(0, 3).map((c) => (Math.sqrt(Math.max(c, 0)) * 1000).toFixed(0)).join('  ')} mm`)] : null,
      known ? ['Normal', known.normal ? h('span', { class: 'numbers' }, formatVector(known.normal)) : 'not known'] : null,
      ...(mean ? [] : this.placeRows(centreOfVoxel(voxel, voxelSize))),
      ...(mean ? this.geographicRow(mean) : []),
    ]),
    details === 'coarse' ? h('p', { class: 'quiet' }, 'A coarse voxel, merged of finer ones. Go nearer for its points, mean and normal.') : null,
    details === 'loading' ? h('p', { class: 'quiet' }, 'Fetching its points, mean and normal …') : null,
    details === 'failed' ? h('p', { class: 'quiet' }, 'Its points, mean and normal could not be fetched.') : null);
  }

  private original(point: Vector): Vector {
    return point.map((x, axis) => x + this.site.anchor[axis]) as unknown as Vector;
  }

  private placeRows(point: Vector): Row[] {
    return [[this.site.epsg === null ? 'Local' : `EPSG:${this.site.epsg}`, h('span', { class: 'numbers' }, formatVector(this.original(point)))], ...this.geographicRow(point)];
  }

  private geographicRow(point: Vector): Row[] {
    if (this.site.epsg === null) return [];
    const { latitude, longitude } = geographicOfLocal(point, this.site.localFromEcef);
    return [['Lat, lon', h('span', { class: 'numbers' }, `${latitude.toFixed(6)}, ${longitude.toFixed(6)}`)]];
  }
}
