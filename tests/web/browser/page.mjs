// SPDX-License-Identifier: GPL-3.0-or-later
// The page in Chromium as the tests use it.
import { mkdirSync, mkdtempSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { writeSite } from '../fixture/site.mjs';
import { openBrowser, serve } from '../support.mjs';

export const PAGE = process.env.VDBMAP_WEB_PAGE ?? join(import.meta.dirname, '../../../tools/web/dist');
export const TAN_HALF_VIEW = Math.tan((25 * Math.PI) / 180);

let site;
/** The made-up street, written once a test file. */
export async function fixtureSite() {
  site ??= (async () => {
    const folder = mkdtempSync(join(tmpdir(), 'vdbmap-site-'));
    mkdirSync(folder, { recursive: true });
    await writeSite(folder);
    return folder;
  })();
  return site;
}

/** One browser and what it says. */
export class Visit {
  messages = [];

  static async start() {
    const visit = new Visit();
    visit.context = await openBrowser();
    return visit;
  }

  /** Opens the page on a site; waits for the full view unless told otherwise. */
  async open(folders, { hash = '', server = {}, media = {}, size = { width: 1060, height: 640 }, wait = true } = {}) {
    await this.close();
    this.messages = [];
    this.server = await serve([PAGE, ...folders], server);
    this.page = await this.context.newPage();
    this.page.on('console', (message) => { if (message.type() === 'error') this.messages.push(message.text()); });
    this.page.on('pageerror', (error) => this.messages.push(String(error)));
    this.page.on('request', (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(this.server.url)) this.messages.push(`asked elsewhere: ${request.url()}`); });
    await this.page.setViewportSize(size);
    await this.page.emulateMedia({ reducedMotion: 'reduce', ...media });
    await this.page.goto(this.server.url + hash);
    if (wait) await this.full();
    return this.page;
  }

  /** Waits until all that the view needs is on the screen. */
  async full() {
    await this.page.waitForTimeout(50);
    await this.page.waitForFunction(() => document.documentElement.dataset.view === 'full', null, { timeout: 60_000 });
  }

  /** Red, green, blue of a place of the window, 0..255. */
  async colourAt(x, y) {
    const picture = await this.page.screenshot({ clip: { x: Math.floor(x), y: Math.floor(y), width: 1, height: 1 } });
    return this.page.evaluate(async (base64) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
      const pen = new OffscreenCanvas(1, 1).getContext('2d');
      pen.drawImage(bitmap, 0, 0);
      return [...pen.getImageData(0, 0, 1, 1).data.slice(0, 3)];
    }, picture.toString('base64'));
  }

  async canvasBox() {
    return this.page.locator('canvas').boundingBox();
  }

  /** Where in the window a plan view shows a place: by the camera's definition, 50 degrees over the canvas' height. */
  async placeOnPlan([x, y], { target, height }) {
    const box = await this.canvasBox();
    const pixelsPerMetre = box.height / (2 * height * TAN_HALF_VIEW);
    return [box.x + box.width / 2 + (x - target[0]) * pixelsPerMetre, box.y + box.height / 2 - (y - target[1]) * pixelsPerMetre];
  }

  async close() {
    await this.page?.close();
    await this.server?.close();
    this.page = this.server = null;
  }

  async end() {
    await this.close();
    await this.context.close();
  }
}

/** Address of a plan view. */
export function planAddress({ target, height }, more = '') {
  return `#camera=plan&eye=${target[0]},${target[1]},${target[2] + height}&target=${target.join(',')}${more}`;
}
