// SPDX-License-Identifier: GPL-3.0-or-later
// What the colours mean, how long a metre is, and where north is.
import type { ColourMode } from '../data/address.ts';
import type { Site } from '../data/site.ts';
import { ageColour, CHANGES, css, heightColour } from '../scene/colours.ts';
import { h, replaceContent } from './dom.ts';
import { epochName, formatMetres } from './format.ts';

function entry(colour: string, name: string): HTMLElement {
  return h('li', {}, h('i', { style: `background:${colour}`, 'aria-hidden': 'true' }), name);
}

function contentOf(mode: ColourMode, site: Site): HTMLElement | null {
  const heading = (name: string) => h('h2', {}, name);
  if (mode === 'height') {
    const stops = [0, 0.2, 0.4, 0.6, 0.8, 1].map((at) => css(heightColour(at))).join(',');
    const [low, high] = [site.bounds.min[2], site.bounds.max[2]].map((z) => formatMetres(z + site.anchor[2]));
    return h('div', {}, heading('Height'), h('div', { class: 'ramp', style: `background:linear-gradient(90deg,${stops})` }), h('p', { class: 'ends' }, h('span', {}, low), h('span', {}, high)));
  }
  if (mode === 'label') return h('div', {}, heading('Class'), h('ul', {}, ...site.labels.map(({ name, color }) => entry(css(color), name))));
  if (mode === 'change') return h('div', {}, heading('Change'), h('ul', {}, ...CHANGES.map(({ name, colour }) => entry(css(colour), name)), entry('rgb(200 202 204)', 'As before')));
  if (mode === 'age') return h('div', {}, heading('Last seen'), h('ul', {}, ...site.epochs.map((epoch, index) => entry(css(ageColour(site.epochs.length - 1 - index, site.epochs.length)), epochName(epoch)))));
  return null;
}

/** 1, 2 or 5 times a power of ten, at most `metres`. */
export function roundLength(metres: number): number {
  const power = 10 ** Math.floor(Math.log10(metres));
  return power * (metres / power >= 5 ? 5 : metres / power >= 2 ? 2 : 1);
}

export class Legend {
  readonly element = h('section', { class: 'legend', 'aria-label': 'Legend', hidden: true });
  readonly scale = h('div', { class: 'scale', 'aria-hidden': 'true' });
  readonly compass: HTMLButtonElement;
  private readonly needle = h('span', { class: 'needle' }, h('b', {}, 'N'));

  constructor(onNorth: () => void) {
    this.compass = h('button', { type: 'button', class: 'compass', 'aria-label': 'Turn north up', title: 'Turn north up (N)', onclick: onNorth }, this.needle);
  }

  show(mode: ColourMode, site: Site): void {
    const content = contentOf(mode, site);
    this.element.hidden = content === null;
    if (content) replaceContent(this.element, content);
  }

  /** bearing: of what is up on the screen, counter-clockwise from east [rad]. */
  place(metresPerPixel: number, bearing: number): void {
    const length = roundLength(110 * metresPerPixel);
    this.scale.style.width = `${length / metresPerPixel}px`;
    this.scale.textContent = length >= 1 ? `${length} m` : `${Math.round(length * 100)} cm`;
    this.needle.style.transform = `rotate(${bearing - Math.PI / 2}rad)`;
  }
}
