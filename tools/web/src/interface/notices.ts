// SPDX-License-Identifier: GPL-3.0-or-later
// What the page says of itself: that it loads, that a part failed, that there is nothing, what to do first.
import { h, icon, replaceContent } from './dom.ts';

const TOAST_MS = 3500;
const HINT_MS = 9000;

export class Notices {
  readonly element = h('div', { class: 'notices' });
  private readonly bar = h('div', { class: 'progress', role: 'progressbar', 'aria-label': 'Loading the map', hidden: true });
  private readonly toast = h('div', { class: 'toast', role: 'status', 'aria-live': 'polite' });
  private readonly failureText = h('span');
  private readonly failure = h('div', { class: 'failure', role: 'alert', hidden: true }, icon('warning'), this.failureText,
    h('button', { type: 'button', class: 'button', onclick: () => this.retry() }, 'Try again'));
  private readonly hint = h('div', { class: 'hint', hidden: true });
  private timer = 0;
  private readonly failed = new Set<string>();
  private readonly onRetry: () => void;

  constructor(onRetry: () => void) {
    this.onRetry = onRetry;
    this.element.append(this.bar, this.failure, this.hint, this.toast);
  }

  progress(isLoading: boolean): void {
    this.bar.hidden = !isLoading;
  }

  say(text: string): void {
    this.toast.textContent = text;
    this.toast.classList.add('shown');
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.toast.classList.remove('shown'), TOAST_MS);
  }

  /** A part that could not be fetched: said once for all of them, with a button to try again. */
  fail(url: string): void {
    this.failed.add(url);
    const parts = this.failed.size === 1 ? 'A part of the map' : `${this.failed.size} parts of the map`;
    this.failureText.textContent = `${parts} could not be loaded. The rest is shown.`;
    this.failure.hidden = false;
  }

  /** Once nothing more is to come: whether there is no rest. */
  sayWhetherAllFailed(isNothingShown: boolean): void {
    if (this.failed.size > 0 && isNothingShown) this.failureText.textContent = 'The map could not be loaded.';
  }

  /** A few words for the first visit, gone with the first touch. */
  showHint(text: string): void {
    this.hint.textContent = text;
    this.hint.hidden = false;
    const hide = () => { this.hint.hidden = true; };
    for (const type of ['pointerdown', 'wheel', 'keydown']) window.addEventListener(type, hide, { once: true, passive: true });
    window.setTimeout(hide, HINT_MS);
  }

  private retry(): void {
    this.failed.clear();
    this.failure.hidden = true;
    this.onRetry();
  }
}

/** Instead of the page: nothing can be shown. */
export function showDeadEnd(root: HTMLElement, title: string, explanation: string, canRetry: boolean): void {
  replaceContent(root, h('main', { class: 'dead-end' }, h('div', { role: 'alert' }, icon('warning'), h('h1', {}, title), h('p', {}, explanation),
    canRetry && h('button', { type: 'button', class: 'button primary', onclick: () => location.reload() }, 'Try again'))));
}
