// SPDX-License-Identifier: GPL-3.0-or-later
// The page on a site that the command `vdbmap web` wrote: both sides agree on what stands in its files.
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { planAddress, Visit } from './page.mjs';

const COMMAND = process.env.VDBMAP_COMMAND;
const ANCHOR = [550000, 5800000, 50]; // [m]

/** A floor of points every 5 cm, 24 m by 24 m: red where x is below 12, green above; a blue block of 2 m stands on it. */
function cloud() {
  const rows = [];
  const add = (x, y, z, color) => rows.push([ANCHOR[0] + x, ANCHOR[1] + y, ANCHOR[2] + z].map((v) => v.toFixed(3)).concat(color).join(' '));
  for (let x = 0.025; x < 24; x += 0.05) for (let y = 0.025; y < 24; y += 0.05) add(x, y, 0.05, x < 12 ? [200, 40, 40] : [40, 180, 60]);
  for (let x = 16.025; x < 18; x += 0.05) for (let y = 6.025; y < 8; y += 0.05) add(x, y, 2.05, [40, 60, 220]);
  const header = ['ply', 'format ascii 1.0', `element vertex ${rows.length}`, ...['x', 'y', 'z'].map((n) => `property double ${n}`), ...['red', 'green', 'blue'].map((n) => `property uchar ${n}`), 'end_header'];
  return [...header, ...rows, ''].join('\n');
}

const near = (colour, expected) => Math.max(...colour.map((c, i) => Math.abs(c - expected[i]))) <= 25;

const hasWeb = Boolean(COMMAND) && spawnSync(COMMAND, ['web', '--help']).status === 0;

describe.skipIf(!hasWeb)('Site of the command', () => {
  let visit;
  let folder;
  let site;
  let shift; // [m] from the places above to map-local ones
  beforeAll(async () => {
    folder = mkdtempSync(join(tmpdir(), 'vdbmap-command-'));
    writeFileSync(join(folder, 'cloud.ply'), cloud());
    const run = (...words) => execFileSync(COMMAND, words, { encoding: 'utf8' });
    run('build', join(folder, 'cloud.ply'), '-o', join(folder, 'map.vdb'), '--epsg', '25832', '--quiet');
    run('web', join(folder, 'map.vdb'), '-o', join(folder, 'site'), '--quiet');
    visit = await Visit.start();
    await visit.open([join(folder, 'site')]);
    site = await (await fetch(`${visit.server.url}site.json`)).json();
    shift = ANCHOR.map((x, axis) => x - site.anchor[axis]);
  });
  afterAll(() => visit?.end());

  const local = (point) => point.map((x, axis) => x + shift[axis]);
  const plan = () => ({ target: local([12, 12, 0]), height: 30 });

  it('is drawn where its points lie', async () => {
    await visit.open([join(folder, 'site')], { hash: planAddress(plan()) });
    expect(visit.messages).toEqual([]);
    for (const [place, colour] of [[[10, 12, 0], [200, 40, 40]], [[14, 12, 0], [40, 180, 60]], [[17, 7, 0], [40, 60, 220]]]) {
      const [x, y] = await visit.placeOnPlan(local(place), plan());
      const seen = await visit.colourAt(x, y);
      expect(near(seen, colour), `${place}: ${seen}`).toBe(true);
    }
  });

  it('tells of a voxel what the command query tells', async () => {
    const page = await visit.open([join(folder, 'site')], { hash: planAddress({ ...plan(), height: 10 }) });
    const [x, y] = await visit.placeOnPlan(local([14.05, 12.05, 0]), { ...plan(), height: 10 });
    await page.mouse.click(x, y);
    await page.getByText('Normal', { exact: true }).waitFor();
    const card = (await page.locator('.card').innerText()).replaceAll(/\s+/g, ' ');
    const at = [14.05, 12.05, 0.05].map((v, axis) => (v + ANCHOR[axis]).toFixed(3));
    const [voxel] = JSON.parse(execFileSync(COMMAND, ['query', join(folder, 'map.vdb'), '--at', at.join(','), '--json'], { encoding: 'utf8' }));
    expect(card).toContain(voxel.id);
    expect(card).toContain(`Points ${voxel.count}`);
    expect(card).toContain(voxel.mean.map((v) => v.toFixed(3)).join(' '));
  });
});
