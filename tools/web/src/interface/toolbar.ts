// SPDX-License-Identifier: GPL-3.0-or-later
// How to look, what the colours say, and the tools.
import { CAMERA_MODES, COLOUR_MODES, type CameraMode, type ColourMode } from '../data/address.ts';
import type { Site } from '../data/site.ts';
import { h, icon, iconButton, type Icon } from './dom.ts';

const CAMERA_NAMES: Record<CameraMode, string> = { orbit: 'Orbit', walk: 'Walk', plan: 'Plan' };
const COLOUR_NAMES: Record<ColourMode, string> = { color: 'True colour', height: 'Height', label: 'Class', change: 'Change', age: 'Last seen' };

export interface ToolbarEvents {
  camera(mode: CameraMode): void;
  colour(mode: ColourMode): void;
  measure(): void;
  home(): void;
  share(): void;
  theme(): void;
  help(): void;
}

/** Whether the map has what a way of colouring shows. */
export function canColourBy(mode: ColourMode, site: Site): boolean {
  const { color, label, change, epoch } = site.attributes;
  return { color, height: true, label, change, age: epoch }[mode];
}

export class Toolbar {
  readonly element: HTMLElement;
  private readonly cameras = new Map<CameraMode, HTMLInputElement>();
  private readonly colours: HTMLSelectElement;
  private readonly measureButton: HTMLButtonElement;

  constructor(site: Site, events: ToolbarEvents) {
    const cameras = h('fieldset', { class: 'segments' }, h('legend', { class: 'hidden' }, 'Camera'));
    for (const [index, mode] of CAMERA_MODES.entries()) {
      const input = h('input', { type: 'radio', name: 'camera', value: mode, 'aria-keyshortcuts': String(index + 1), onchange: () => events.camera(mode) });
      this.cameras.set(mode, input);
      cameras.append(h('label', { title: `${CAMERA_NAMES[mode]} (${index + 1})` }, input, icon(mode as Icon), h('span', {}, CAMERA_NAMES[mode])));
    }
    this.colours = h('select', { id: 'colour', 'aria-label': 'Colour by', onchange: () => events.colour(this.colours.value as ColourMode) });
    for (const mode of COLOUR_MODES) {
      const isThere = canColourBy(mode, site);
      this.colours.append(h('option', { value: mode, disabled: !isThere }, isThere ? COLOUR_NAMES[mode] : `${COLOUR_NAMES[mode]} (not in this map)`));
    }
    this.measureButton = iconButton('measure', 'Measure a distance (M)', events.measure, { 'aria-pressed': 'false' });
    this.element = h('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'View' }, cameras,
      h('label', { class: 'colours', title: 'Colour by' }, icon('colour'), this.colours),
      h('div', { class: 'buttons' }, this.measureButton, iconButton('home', 'Show the whole map (H)', events.home), iconButton('share', 'Copy the address of this view (S)', events.share),
        iconButton('theme', 'Light or dark', events.theme), iconButton('help', 'Help (?)', events.help)));
  }

  show(camera: CameraMode, colour: ColourMode, isMeasuring: boolean): void {
    this.cameras.get(camera)!.checked = true;
    this.colours.value = colour;
    this.measureButton.setAttribute('aria-pressed', String(isMeasuring));
  }
}
