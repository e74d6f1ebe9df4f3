// SPDX-License-Identifier: GPL-3.0-or-later
import type { CameraMode } from '../data/address.ts';
import type { CameraRig } from '../scene/camera_rig.ts';
import { isTyping } from './dom.ts';

export interface Shortcuts {
  camera(mode: CameraMode): void;
  search(): void;
  step(by: number): void;
  compare(): void;
  measure(): void;
  share(): void;
  home(): void;
  north(): void;
  help(): void;
  escape(): void;
}

const WALK: Record<string, string> = { ArrowUp: 'forward', ArrowDown: 'back', w: 'forward', s: 'back', a: 'left', d: 'right' };
const PAN: Record<string, [number, number]> = { ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };
const STEP = 0.08; // of the view
const TURN = 0.09; // [rad]

/** Moves by keys; true where the key was one of those. */
function move(event: KeyboardEvent, rig: CameraRig): boolean {
  const pan = PAN[event.key];
  if (rig.mode === 'walk') {
    if (event.key === 'ArrowLeft' || event.key === 'ArrowRight') rig.turn(event.key === 'ArrowLeft' ? TURN : -TURN, 0);
    else if (event.shiftKey && pan) rig.turn(0, pan[1] * TURN);
    else if (WALK[event.key]) rig.press(WALK[event.key], true);
    else return false;
    return true;
  }
  if (pan && event.shiftKey) rig.turn(-pan[0] * TURN, pan[1] * TURN);
  else if (pan) rig.pan(pan[0] * STEP, pan[1] * STEP);
  else if (event.key === '+' || event.key === '=') rig.zoom(0.85);
  else if (event.key === '-') rig.zoom(1 / 0.85);
  else return false;
  return true;
}

export function listenToKeys(rig: CameraRig, shortcuts: Shortcuts): void {
  const actions: Record<string, () => void> = {
    '1': () => shortcuts.camera('orbit'), '2': () => shortcuts.camera('walk'), '3': () => shortcuts.camera('plan'),
    '/': shortcuts.search, '[': () => shortcuts.step(-1), ']': () => shortcuts.step(1), c: shortcuts.compare, m: shortcuts.measure,
    s: shortcuts.share, h: shortcuts.home, n: shortcuts.north, '?': shortcuts.help, Escape: shortcuts.escape,
  };
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (event.key === 'Escape') return shortcuts.escape();
    const isControl = event.target instanceof HTMLElement && event.target.matches('input, [role=slider], dialog, dialog *');
    if (isTyping(event.target) || (isControl && event.key.startsWith('Arrow'))) return;
    const isDone = move(event, rig) || (actions[event.key] !== undefined && (actions[event.key](), true));
    if (isDone) event.preventDefault();
  });
  window.addEventListener('keyup', (event) => {
    const direction = WALK[event.key];
    if (direction) rig.press(direction, false);
  });
  window.addEventListener('blur', () => { for (const direction of Object.values(WALK)) rig.press(direction, false); });
}
