// SPDX-License-Identifier: GPL-3.0-or-later
// The dates of the map: one to look at, or two beside each other with a line between them to drag.
import type { Epoch } from '../data/site.ts';
import { h, icon, iconButton, replaceContent } from './dom.ts';
import { epochName, formatDate } from './format.ts';

export interface TimelineEvents {
  epoch(id: string): void;
  compare(before: string | null): void;
  split(share: number): void;
}

export class Timeline {
  readonly element = h('div', { class: 'timeline', role: 'group', 'aria-label': 'Dates' });
  /** Over the picture: the names of both dates, and the line. */
  readonly curtain = h('div', { class: 'curtain', hidden: true });
  private readonly slider: HTMLInputElement;
  private readonly name = h('output', { class: 'epoch', for: 'epoch' });
  private readonly compareButton: HTMLButtonElement;
  private readonly beforeField: HTMLSelectElement;
  private readonly line: HTMLElement;
  private readonly names = { before: h('span', { class: 'name before' }), after: h('span', { class: 'name after' }) };
  private readonly epochs: readonly Epoch[];
  private readonly events: TimelineEvents;

  constructor(epochs: readonly Epoch[], events: TimelineEvents) {
    this.epochs = epochs;
    this.events = events;
    this.slider = h('input', { type: 'range', id: 'epoch', min: 0, max: Math.max(epochs.length - 1, 0), step: 1, 'aria-label': 'Date', oninput: () => events.epoch(epochs[Number(this.slider.value)].id) });
    this.compareButton = h('button', { type: 'button', class: 'button', 'aria-pressed': 'false', title: 'Before and after side by side (C)', onclick: () => this.toggleComparison() }, icon('compare'), h('span', {}, 'Compare'));
    this.beforeField = h('select', { 'aria-label': 'Compare with', hidden: true, onchange: () => events.compare(this.beforeField.value) }, ...epochs.map((epoch) => h('option', { value: epoch.id }, epochName(epoch))));
    this.line = h('div', { class: 'line', role: 'slider', tabindex: 0, 'aria-label': 'Line between before and after', 'aria-valuemin': 0, 'aria-valuemax': 100, 'aria-orientation': 'horizontal' }, h('span', { class: 'grip' }, icon('previous'), icon('next')));
    this.curtain.append(this.names.before, this.names.after, this.line);
    this.addDragging();
    this.fill();
  }

  show(epoch: string, before: string | null, split: number): void {
    const index = this.epochs.findIndex(({ id }) => id === epoch);
    const name = epochName(this.epochs[index]);
    const { date } = this.epochs[index];
    this.slider.value = String(index);
    this.slider.setAttribute('aria-valuetext', name);
    replaceContent(this.name, h('b', {}, name), date && formatDate(date) !== name ? ` ${formatDate(date)}` : '');
    this.compareButton.setAttribute('aria-pressed', String(before !== null));
    this.beforeField.hidden = before === null || this.epochs.length < 3;
    this.curtain.hidden = before === null;
    if (before === null) return;
    this.beforeField.value = before;
    const earlier = this.epochs.find(({ id }) => id === before);
    this.names.before.textContent = earlier ? epochName(earlier) : before;
    this.names.after.textContent = name;
    this.placeLine(split);
  }

  toggleComparison(): void {
    if (this.epochs.length < 2) return;
    const isOn = this.compareButton.getAttribute('aria-pressed') === 'true';
    const index = Number(this.slider.value);
    this.events.compare(isOn ? null : this.epochs[index > 0 ? index - 1 : 1].id);
  }

  step(by: number): void {
    const epoch = this.epochs[Number(this.slider.value) + by];
    if (epoch) this.events.epoch(epoch.id);
  }

  private fill(): void {
    if (this.epochs.length < 2) {
      this.element.append(this.name);
      this.element.hidden = !this.epochs[0].date; // a single number says nothing
      return;
    }
    const ticks = h('div', { class: 'ticks', 'aria-hidden': 'true' }, ...this.epochs.map(() => h('i')));
    this.element.append(iconButton('previous', 'Earlier date ([)', () => this.step(-1)), h('div', { class: 'dates' }, this.name, h('div', { class: 'track' }, ticks, this.slider)),
      iconButton('next', 'Later date (])', () => this.step(1)), this.compareButton, this.beforeField);
  }

  private placeLine(split: number): void {
    this.curtain.style.setProperty('--split', `${split * 100}%`);
    this.line.setAttribute('aria-valuenow', String(Math.round(split * 100)));
  }

  private addDragging(): void {
    const move = (event: PointerEvent) => {
      const { left, width } = this.curtain.getBoundingClientRect();
      this.moveTo((event.clientX - left) / width);
    };
    this.line.addEventListener('pointerdown', (event) => {
      this.line.setPointerCapture(event.pointerId);
      this.line.addEventListener('pointermove', move);
    });
    this.line.addEventListener('lostpointercapture', () => this.line.removeEventListener('pointermove', move));
    this.line.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      this.moveTo(Number(this.line.getAttribute('aria-valuenow')) / 100 + step);
    });
  }

  private moveTo(share: number): void {
    const split = Math.min(Math.max(share, 0.02), 0.98);
    this.placeLine(split);
    this.events.split(split);
  }
}
