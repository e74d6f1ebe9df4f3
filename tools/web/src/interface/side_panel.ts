// SPDX-License-Identifier: GPL-3.0-or-later
// Beside the picture: what this is, a search field, and the parking spaces with their counts.
import { isEmpty, type Site } from '../data/site.ts';
import { count, isNew, matches, stateAt, type Filter, type Space } from '../data/spaces.ts';
import { h, icon, iconButton, replaceContent } from './dom.ts';
import { formatCount, formatPercent, plural, STATE_NAMES } from './format.ts';

const FILTERS: readonly { filter: Filter; name: string }[] = [
  { filter: 'all', name: 'All' },
  { filter: 'occupied', name: 'Occupied' },
  { filter: 'vacant', name: 'Vacant' },
  { filter: 'unknown', name: 'Unknown' },
  { filter: 'changed', name: 'Changed' },
];

export interface SidePanelEvents {
  search(text: string): void;
  filter(filter: Filter): void;
  choose(space: Space): void;
}

/** Symbol of a state that does not need its colour. */
export function stateMark(state: string): HTMLElement {
  return h('span', { class: `mark ${state}`, 'aria-hidden': 'true' });
}

export class SidePanel {
  readonly element: HTMLElement;
  readonly searchField = h('input', { type: 'search', id: 'search', placeholder: 'Space, voxel or coordinates', autocomplete: 'off', spellcheck: 'false', 'aria-describedby': 'search-answer' });
  private readonly answer = h('p', { id: 'search-answer', class: 'answer', role: 'status' });
  private readonly filters = h('div', { class: 'filters', role: 'group', 'aria-label': 'Show spaces' });
  private readonly list = h('ul', { class: 'spaces', 'aria-label': 'Parking spaces' });
  private readonly heading = h('h2', {}, 'Parking spaces');
  private readonly share = h('p', { class: 'quiet' });
  private readonly toggle: HTMLButtonElement;
  private readonly site: Site;
  private readonly events: SidePanelEvents;

  constructor(site: Site, events: SidePanelEvents) {
    this.site = site;
    this.events = events;
    this.toggle = iconButton('up', 'Show the list of spaces', () => this.open(!this.isOpen), { class: 'icon-button sheet-toggle', 'aria-expanded': 'false' });
    const form = h('form', { class: 'search', role: 'search', onsubmit: (event: Event) => { event.preventDefault(); events.search(this.searchField.value); } },
      h('label', { for: 'search', class: 'hidden' }, 'Search by space, voxel id or coordinates'), icon('search'), this.searchField);
    this.element = h('aside', { class: 'side', 'aria-label': 'About this map' },
      h('header', {}, h('div', {}, h('h1', {}, site.name), h('p', { class: 'quiet' }, this.describe())), this.toggle),
      form, this.answer,
      h('section', { class: 'list', 'aria-labelledby': 'spaces-heading' }, this.heading, this.share, this.filters, this.list),
      site.attribution ? h('footer', { class: 'quiet' }, site.attribution) : null);
    this.heading.id = 'spaces-heading';
  }

  get isOpen(): boolean {
    return this.element.classList.contains('open');
  }

  /** On narrow screens the panel is a sheet. */
  open(isOpen: boolean): void {
    this.element.classList.toggle('open', isOpen);
    this.toggle.setAttribute('aria-expanded', String(isOpen));
    this.toggle.setAttribute('aria-label', isOpen ? 'Hide the list of spaces' : 'Show the list of spaces');
    replaceContent(this.toggle, icon(isOpen ? 'down' : 'up'));
  }

  say(answer: string): void {
    this.answer.textContent = answer;
  }

  /** Instead of the list. */
  sayNoSpaces(reason: string): void {
    replaceContent(this.filters);
    replaceContent(this.list);
    this.share.textContent = reason;
  }

  showSpaces(spaces: readonly Space[], epoch: string, filter: Filter, selected: string | null): void {
    const epochs = this.site.epochs.map(({ id }) => id);
    const known = count(spaces, 'occupied', epoch, epochs) + count(spaces, 'vacant', epoch, epochs);
    const taken = count(spaces, 'occupied', epoch, epochs);
    this.share.textContent = known > 0 ? `${formatPercent(taken / known)} of the ${plural(known, 'space')} that could be seen are taken` : 'None of the spaces could be seen';
    replaceContent(this.filters, ...FILTERS.filter(({ filter: f }) => f !== 'changed' || epochs[0] !== epoch).map(({ filter: each, name }) =>
      h('button', { type: 'button', class: `chip ${each}`, 'aria-pressed': String(each === filter), onclick: () => this.events.filter(each) }, name, h('b', {}, formatCount(count(spaces, each, epoch, epochs))))));
    const shown = spaces.filter((space) => matches(space, filter, epoch, epochs));
    const focused = document.activeElement?.getAttribute('data-space');
    replaceContent(this.list, ...shown.map((space) => this.row(space, epoch, epochs, space.id === selected)));
    if (shown.length === 0) this.list.append(h('li', { class: 'quiet' }, 'No such space at this date'));
    if (focused) this.list.querySelector<HTMLElement>(`[data-space="${CSS.escape(focused)}"]`)?.focus();
    this.list.querySelector('[aria-current]')?.scrollIntoView({ block: 'nearest' });
  }

  private row(space: Space, epoch: string, epochs: string[], isSelected: boolean): HTMLElement {
    const state = stateAt(space, epoch);
    return h('li', {}, h('button', { type: 'button', class: 'space', 'data-space': space.id, 'aria-current': isSelected ? 'true' : null, onclick: () => this.events.choose(space) },
      stateMark(state), h('span', { class: 'id' }, space.id), h('span', { class: 'state' }, STATE_NAMES[state]), isNew(space, epoch, epochs) && h('span', { class: 'new' }, 'new')));
  }

  private describe(): string {
    const { bounds, epsg, epochs } = this.site;
    if (isEmpty(this.site)) return 'An empty map';
    const [length, width] = [0, 1].map((axis) => Math.round(bounds.max[axis] - bounds.min[axis])).sort((a, b) => b - a);
    const voxels = epochs.at(-1)!.voxels;
    const place = epsg === null ? 'local coordinates' : `EPSG:${epsg}`;
    return `${length} × ${width} m · ${formatCount(voxels)} voxels · ${place}`;
  }
}
