// SPDX-License-Identifier: GPL-3.0-or-later
// Another viewer than ours reads the tiles, and draws them at the right place on the globe.
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { PLACE } from '../fixture/site.mjs';
import { openBrowser, serve } from '../support.mjs';
import { fixtureSite } from './page.mjs';

const CESIUM = join(import.meta.dirname, '../node_modules/cesium/Build/Cesium');
const PAGE = `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">
<style>html, body, #globe { margin: 0; width: 640px; height: 480px; overflow: hidden }</style>
<script>window.CESIUM_BASE_URL = '/';</script><script src="/Cesium.js"></script><div id="globe"></div>`;

/** Runs in the page: a globe without imagery, which asks no server. */
async function openTileset(url) {
  const { Cesium } = window;
  Cesium.Ion.defaultAccessToken = undefined;
  const widget = new Cesium.CesiumWidget('globe', { baseLayer: false, skyBox: false, skyAtmosphere: false, useDefaultRenderLoop: false, scene3DOnly: true, showRenderLoopErrors: false, contextOptions: { webgl: { preserveDrawingBuffer: true } } });
  const { scene } = widget;
  scene.globe.show = false;
  scene.fog.enabled = false;
  scene.backgroundColor = Cesium.Color.MAGENTA;
  const tileset = await Cesium.Cesium3DTileset.fromUrl(url, { maximumScreenSpaceError: 4 });
  tileset.style = new Cesium.Cesium3DTileStyle({ pointSize: '7' });
  scene.primitives.add(tileset);
  Object.assign(window, { scene, tileset });
}

/** Runs in the page: the colour of what lies at east, north of a place, seen from 25 m above it. */
async function colourFromAbove({ place, east, north }) {
  const { Cesium, scene, tileset } = window;
  const frame = Cesium.Transforms.eastNorthUpToFixedFrame(Cesium.Cartesian3.fromDegrees(place.longitude, place.latitude, place.height));
  const destination = Cesium.Matrix4.multiplyByPoint(frame, new Cesium.Cartesian3(east, north, 25), new Cesium.Cartesian3());
  scene.camera.setView({ destination, orientation: { heading: 0, pitch: -Cesium.Math.PI_OVER_TWO, roll: 0 } });
  for (let frameNumber = 0; frameNumber < 600; ++frameNumber) {
    scene.initializeFrame();
    scene.render();
    if (frameNumber > 3 && tileset.tilesLoaded) break;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  const gl = scene.context._gl;
  const bytes = new Uint8Array(4);
  gl.readPixels(gl.drawingBufferWidth >> 1, gl.drawingBufferHeight >> 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return [...bytes.slice(0, 3)];
}

describe('CesiumJS', () => {
  let context;
  let server;
  let page;
  const messages = [];
  beforeAll(async () => {
    const folder = mkdtempSync(join(tmpdir(), 'vdbmap-cesium-'));
    writeFileSync(join(folder, 'index.html'), PAGE);
    server = await serve([folder, await fixtureSite(), CESIUM]);
    context = await openBrowser();
    page = await context.newPage();
    await page.setViewportSize({ width: 640, height: 480 });
    page.on('console', (message) => { if (message.type() === 'error') messages.push(message.text()); });
    page.on('pageerror', (error) => messages.push(String(error)));
    await page.goto(server.url);
    await page.evaluate(openTileset, '/tileset_1.json');
  });
  afterAll(async () => {
    await context?.close();
    await server?.close();
  });

  it('finds the street where it is', async () => {
    const { longitude, latitude, radius } = await page.evaluate(() => {
      const { center, radius: r } = window.tileset.boundingSphere;
      const at = window.Cesium.Cartographic.fromCartesian(center);
      return { longitude: window.Cesium.Math.toDegrees(at.longitude), latitude: window.Cesium.Math.toDegrees(at.latitude), radius: r };
    });
    // The street runs 50 m eastwards from the place: its middle is 25 m away, which is 0.000366 degrees there.
    expect(longitude).toBeCloseTo(PLACE.longitude + 25.3 / (111320 * Math.cos((PLACE.latitude * Math.PI) / 180)), 4);
    expect(latitude).toBeCloseTo(PLACE.latitude, 4);
    expect(radius).toBeLessThan(32);
  });

  it('draws its colours there', async () => {
    const colours = {};
    for (const [name, east, north] of [['road', 24, 2], ['lawn', 24, 9.5], ['roof', 24, -10.9], ['nothing', 24, 14]]) colours[name] = await page.evaluate(colourFromAbove, { place: PLACE, east, north });
    const { road, lawn, roof, nothing } = colours;
    const text = JSON.stringify(colours);
    expect(nothing, text).toEqual([255, 0, 255]);
    expect(Math.max(...road) - Math.min(...road), `grey: ${text}`).toBeLessThan(30);
    expect(lawn[1], `green: ${text}`).toBeGreaterThan(Math.max(lawn[0], lawn[2]) + 10);
    expect(roof[0], `red: ${text}`).toBeGreaterThan(Math.max(roof[1], roof[2]) + 15);
    expect(messages).toEqual([]);
  });
});
