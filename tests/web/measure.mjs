// SPDX-License-Identifier: GPL-3.0-or-later
// How fast the page shows a site, how much it fetches, and how much memory it takes: measure.mjs SITE_FOLDER [PAGE_FOLDER] [RUNS]
// Chromium without a window, 1280 x 800, WebGL in software; each run with an empty cache. The flight visits places all over the map.
import { join } from 'node:path';
import { openBrowser, serve } from './support.mjs';

const [site, page = join(import.meta.dirname, '../../build/release/share/vdbmap/web'), runs = '5'] = process.argv.slice(2);
const MEGABYTE = 1e6;
const FLIGHT = 12; // places

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const bytesOf = (requests) => requests.reduce((sum, { bytes }) => sum + bytes, 0);

/** Heap and array buffers of the page [MB], after a collection. */
async function memory(session) {
  await session.send('HeapProfiler.collectGarbage');
  const { usedSize, backingStorageSize = 0 } = await session.send('Runtime.getHeapUsage');
  return { heap: usedSize / MEGABYTE, buffers: backingStorageSize / MEGABYTE };
}

async function full(tab) {
  await tab.waitForTimeout(300);
  await tab.waitForFunction(() => document.documentElement.dataset.view === 'full', null, { timeout: 120_000 });
}

/** Flies to places where there are voxels; returns the largest memory [MB] and what was fetched twice. */
async function fly(tab, session, server) {
  let largest = 0;
  const points = await tab.evaluate(() => window.vdbmap.viewer.samplePoints());
  for (let i = 0; i < FLIGHT; ++i) {
    const [x, y, z] = points[Math.floor(((i + 0.5) / FLIGHT) * points.length)];
    await tab.evaluate((hash) => { location.hash = hash; }, `camera=orbit&eye=${x - 25},${y - 15},${z + 22}&target=${x},${y},${z}`);
    await full(tab);
    const { heap, buffers } = await memory(session);
    largest = Math.max(largest, heap + buffers);
  }
  const tiles = server.requests.map(({ path }) => path).filter((path) => path.endsWith('.glb'));
  return { largest, tiles: new Set(tiles).size, twice: tiles.length - new Set(tiles).size };
}

async function run(isLast) {
  const server = await serve([page, site]);
  const context = await openBrowser();
  const tab = await context.newPage();
  const session = await context.newCDPSession(tab);
  await tab.goto(server.url);
  await tab.waitForFunction(() => performance.getEntriesByName('first-picture').length > 0, null, { timeout: 120_000 });
  const first = bytesOf(server.requests);
  await full(tab);
  const marks = await tab.evaluate(() => Object.fromEntries(performance.getEntriesByType('mark').map(({ name, startTime }) => [name, startTime / 1000])));
  const { voxels } = await tab.evaluate(() => window.vdbmap.statistics());
  const result = { firstPicture: marks['first-picture'], fullView: marks['full-view'], fetchedFirst: first / MEGABYTE, fetched: bytesOf(server.requests) / MEGABYTE, voxels, ...(await memory(session)) };
  if (isLast) result.flight = await fly(tab, session, server);
  await context.close();
  await server.close();
  return result;
}

const results = [];
for (let i = 0; i < Number(runs); ++i) results.push(await run(i === Number(runs) - 1));
const row = (name, key, unit, digits = 2) => console.log(`| ${name} | ${median(results.map((r) => r[key])).toFixed(digits)} ${unit} | ${Math.min(...results.map((r) => r[key])).toFixed(digits)} to ${Math.max(...results.map((r) => r[key])).toFixed(digits)} |`);
console.log(`${site}, median of ${runs} runs\n\n| | median | range |\n|---|---|---|`);
row('first picture', 'firstPicture', 's');
row('full view', 'fullView', 's');
row('fetched until then, the page of 0.9 MB included', 'fetched', 'MB');
row('voxels shown', 'voxels', '', 0);
row('JavaScript heap', 'heap', 'MB', 1);
row('array buffers', 'buffers', 'MB', 1);
const { flight } = results.at(-1);
console.log(`| flight over ${FLIGHT} places: largest heap and buffers | ${flight.largest.toFixed(1)} MB | |\n| tiles fetched in it, of them again | ${flight.tiles}, ${flight.twice} | |`);
