// SPDX-License-Identifier: GPL-3.0-or-later
import './style.css';
import { App } from './app.ts';
import { readSite, SiteError } from './data/site.ts';
import { readSpaces } from './data/spaces.ts';
import { showDeadEnd } from './interface/notices.ts';

const DEFAULT_BUDGET_MB = 96; // of voxels, in memory and on the graphics card together

async function fetchJson(url: string): Promise<unknown> {
  const response = await fetch(url);
  if (!response.ok) throw new SiteError(`${url}: ${response.status === 404 ? 'not found' : `${response.status} ${response.statusText}`}`);
  try {
    return await response.json();
  } catch {
    throw new SiteError(`${url} is not JSON`);
  }
}

function budgetBytes(): number {
  const megabytes = Number(new URLSearchParams(location.search).get('memory'));
  return 2 ** 20 * (megabytes >= 8 ? megabytes : DEFAULT_BUDGET_MB);
}

async function showSpaces(spaces: Promise<unknown> | null, app: App): Promise<void> {
  if (spaces === null) return app.setSpaces([]);
  try {
    app.setSpaces(readSpaces(await spaces));
  } catch (error) {
    app.sayNoSpaces(`The parking spaces could not be loaded: ${error instanceof Error ? error.message : error}`);
  }
}

async function start(root: HTMLElement): Promise<void> {
  try {
    const site = readSite(await fetchJson('site.json'));
    if (site.epochs.length === 0) return showDeadEnd(root, 'There is nothing to show', 'This site holds no map yet.', false);
    const spaces = site.spaces === null ? null : fetchJson(site.spaces);
    spaces?.catch(() => undefined); // said once there is a page
    const app = new App(root, site, budgetBytes());
    Object.assign(window, { vdbmap: app });
    await showSpaces(spaces, app);
  } catch (error) {
    const message = error instanceof Error ? error.message : String(error);
    if (error instanceof SiteError) return showDeadEnd(root, 'The map could not be loaded', message, true);
    if (/webgl/i.test(message)) return showDeadEnd(root, 'This browser cannot draw the map', 'It needs WebGL 2, which is missing or switched off here.', true);
    showDeadEnd(root, 'The map could not be shown', message, true);
    throw error;
  }
}

void start(document.getElementById('app')!);
