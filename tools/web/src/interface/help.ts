// SPDX-License-Identifier: GPL-3.0-or-later
import { h, iconButton } from './dom.ts';

const KEYS: readonly [string, string][] = [
  ['1  2  3', 'Orbit, walk, plan'],
  ['Arrows', 'Move; on foot: walk and turn'],
  ['Shift + arrows', 'Turn and tilt'],
  ['+  −', 'Nearer, farther'],
  ['H', 'The whole map'],
  ['N', 'North up'],
  ['/', 'Search'],
  ['[  ]', 'Earlier, later date'],
  ['C', 'Compare two dates'],
  ['M', 'Measure a distance'],
  ['S', 'Copy the address of this view'],
  ['Esc', 'Close, stop measuring'],
];

const GESTURES: readonly [string, string][] = [
  ['Drag', 'Turn (plan: move; on foot: look around)'],
  ['Right button, or two fingers', 'Move'],
  ['Wheel, or pinch', 'Nearer, farther'],
  ['Click, or tap', 'What is this? A parking space or a voxel'],
];

function rows(entries: readonly [string, string][]): HTMLElement {
  return h('dl', {}, ...entries.flatMap(([key, meaning]) => [h('dt', {}, key), h('dd', {}, meaning)]));
}

export function makeHelp(): HTMLDialogElement {
  const dialog = h('dialog', { class: 'help', 'aria-labelledby': 'help-title' });
  dialog.append(h('header', {}, h('h2', { id: 'help-title' }, 'How to look around'), iconButton('close', 'Close help', () => dialog.close())),
    h('div', { class: 'columns' }, h('section', {}, h('h3', {}, 'Mouse and touch'), rows(GESTURES)), h('section', {}, h('h3', {}, 'Keys'), rows(KEYS))),
    h('p', { class: 'quiet' }, 'Boxes: red and a bar: occupied. Green and a ring: vacant. Grey and a question mark: could not be seen. A yellow rim: new since the date before.'));
  dialog.addEventListener('click', (event) => { if (event.target === dialog) dialog.close(); });
  return dialog;
}
