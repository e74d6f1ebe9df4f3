// SPDX-License-Identifier: GPL-3.0-or-later
// Elements in one line each.

type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

/** An element with attributes ('onclick': a listener; true: there; null, undefined and false: left out) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(name.slice(2), value as unknown as EventListener);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
  return element;
}

export function replaceContent(element: Element, ...children: Child[]): void {
  element.replaceChildren(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
}

const ICONS = {
  orbit: 'M12 4a8 3.2 0 1 0 0 16 8 8 0 0 0 0-16M4 12c0 1.8 3.6 3.2 8 3.2s8-1.4 8-3.2',
  walk: 'M13 4.5a.6.6 0 1 0 .1 0M9 21l2.4-6L9.5 12l1-4.2L14 9l1 3 2.5 1M13 15l2 6M9.800 8 7 10l-.6 3',
  plan: 'M3 6l6-2 6 2 6-2v14l-6 2-6-2-6 2zM9 4v14M15 6v14',
  measure: 'M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2',
  share: 'M10 14a4 4 0 0 0 6 .4l3-3a4 4 0 0 0-5.700-5.700L12 7M14 10a4 4 0 0 0-6-.4l-3 3a4 4 0 0 0 5.700 5.700L12 17',
  home: 'M4 11.500 12 5l8 6.500M6.500 10v9h11v-9M10 19v-5h4v5',
  theme: 'M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9',
  help: 'M9.200 9a2.900 2.900 0 1 1 4.200 2.600c-1 .5-1.400 1-1.400 2.200M12 17.300v.2',
  compare: 'M12 3v18M4 6h5v12H4zM15 6h5v12h-5z',
  search: 'M11 4a7 7 0 1 0 0 14 7 7 0 0 0 0-14M16 16l5 5',
  close: 'M6 6l12 12M18 6 6 18',
  copy: 'M9 9h11v11H9zM5 15H4V4h11v1',
  list: 'M9 6h11M9 12h11M9 18h11M4.500 6v.1M4.500 12v.1M4.500 18v.1',
  previous: 'M14 6l-6 6 6 6',
  next: 'M10 6l6 6-6 6',
  up: 'M6 14l6-6 6 6',
  down: 'M6 10l6 6 6-6',
  warning: 'M12 4 2.500 20h19zM12 10v5M12 17.500v.2',
  colour: 'M12 3a9 9 0 0 0 0 18c2 0 2-1.500 1.300-2.500-.8-1.200 0-2.500 1.700-2.500H18a3 3 0 0 0 3-3c0-5-4-10-9-10M7.500 11v.1M11 7.500v.1M15.500 8.500v.1',
} as const;
export type Icon = keyof typeof ICONS;

/** A picture beside a text, or in a button that has a label of its own. */
export function icon(name: Icon): SVGSVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  for (const [key, value] of Object.entries({ viewBox: '0 0 24 24', width: 20, height: 20, fill: 'none', stroke: 'currentColor', 'stroke-width': 1.7, 'stroke-linecap': 'round', 'stroke-linejoin': 'round', 'aria-hidden': 'true' }))
    svg.setAttribute(key, String(value));
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}

/** A button with a picture only. */
export function iconButton(name: Icon, label: string, onclick: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h('button', { type: 'button', class: 'icon-button', 'aria-label': label, title: label, onclick, ...attributes }, icon(name));
}

export function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && (target.matches('input:not([type=range]), textarea, select') || target.isContentEditable);
}
