// SPDX-License-Identifier: GPL-3.0-or-later
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import axe from 'axe-core';
import { idOfVoxel, textOfId } from '../../../tools/web/src/data/voxel_id.ts';
import { fixtureSite, planAddress, Visit } from './page.mjs';

let visit;
let site;
beforeAll(async () => {
  site = await fixtureSite();
  visit = await Visit.start();
});
afterEach(() => visit.close());
afterAll(() => visit?.end());

const RED = (c) => c[0] > c[1] + 25 && c[0] > c[2] + 25;
const GREEN = (c) => c[1] > c[0] + 15 && c[1] > c[2] + 5;
const near = (colour, expected, tolerance) => Math.max(...colour.map((c, i) => Math.abs(c - expected[i]))) <= tolerance;

/** The site's site.json changed, in a folder that is served before it. */
function changedSite(change) {
  const folder = mkdtempSync(join(tmpdir(), 'vdbmap-change-'));
  const json = JSON.parse(readFileSync(join(site, 'site.json')));
  change(json, folder);
  writeFileSync(join(folder, 'site.json'), JSON.stringify(json));
  return folder;
}

describe('Page', () => {
  it('loads without errors and asks nobody else', async () => {
    const page = await visit.open([site]);
    expect(visit.messages).toEqual([]);
    expect(await page.title()).toBe('Test street');
    const { voxels } = await page.evaluate(() => window.vdbmap.statistics());
    expect(voxels).toBeGreaterThan(250_000);
  });

  it('draws voxels where they belong', async () => {
    // By class, from above: tops are as bright as their colour. Places on open ground, away from shade and spaces.
    const plan = { target: [24, 0, 0], height: 50 };
    await visit.open([site], { hash: planAddress(plan, '&colour=label') });
    const expected = [[[24, 2], [128, 64, 128]], [[42, -2], [128, 64, 128]], [[7.5, 8.5], [130, 90, 160]], [[24, 9.5], [150, 200, 110]], [[17, -9.5], [150, 200, 110]]];
    for (const [place, colour] of expected) {
      const [x, y] = await visit.placeOnPlan(place, plan);
      const seen = await visit.colourAt(x, y);
      expect(near(seen, colour, 14), `${place}: ${seen}, not ${colour}`).toBe(true);
    }
    const [x, y] = await visit.placeOnPlan([24, 12.8], plan);
    expect(near(await visit.colourAt(x, y), [128, 64, 128], 60), 'beside the map there is none').toBe(false);
  });

  it('picks the voxel under the pointer, with its details', async () => {
    const plan = { target: [24, 0, 0], height: 12 };
    const page = await visit.open([site], { hash: planAddress(plan) });
    const [x, y] = await visit.placeOnPlan([24.35, 1.25], plan);
    await page.mouse.click(x, y);
    await page.getByText('Normal', { exact: true }).waitFor();
    const card = await page.locator('.card').innerText();
    expect(card).toContain('Voxel of 10 cm');
    expect(card).toContain(textOfId(idOfVoxel([243, 12, 0])));
    expect(card).toContain('road');
    // As the fixture has them: 4 points and more by position, the mean 4, 5 and 6 cm from the low corner.
    expect(card).toMatch(new RegExp(`Points\\s+${4 + ((243 + 12) & 7)}\\b`));
    expect(card.replaceAll(/\s+/g, ' ')).toContain('550024.340 5800001.250 50.060');
    expect(card.replaceAll(/\s+/g, ' ')).toContain('0.00 0.00 1.00');
    expect(visit.messages).toEqual([]);
  });

  it('reads details from servers that know no ranges', async () => {
    const plan = { target: [24, 0, 0], height: 12 };
    const page = await visit.open([site], { hash: planAddress(plan), server: { hasRanges: false } });
    const [x, y] = await visit.placeOnPlan([24.35, 1.25], plan);
    await page.mouse.click(x, y);
    await page.getByText('Normal', { exact: true }).waitFor();
    expect((await page.locator('.card').innerText()).replaceAll(/\s+/g, ' ')).toContain('550024.340 5800001.250 50.060');
  });

  it('turns freed spaces green as the dates go by', async () => {
    const plan = { target: [14.4, 4.8, 0], height: 14 };
    const page = await visit.open([site], { hash: planAddress(plan, '&epoch=1') });
    // N3 is taken at first and free later; a place of it beside the car and away from its badge.
    const [x, y] = await visit.placeOnPlan([18.3, 5.7], plan);
    const before = await visit.colourAt(x, y);
    await page.locator('#epoch').fill('1');
    await visit.full();
    const after = await visit.colourAt(x, y);
    expect(RED(before), `${before}`).toBe(true);
    expect(GREEN(after), `${after}`).toBe(true);
    const row = page.locator('[data-space=N3]');
    expect(await row.textContent()).toMatch(/Vacant[\s\S]*new/);
  });

  it('shows before and after side by side', async () => {
    const plan = { target: [18.3, 4.9, 0], height: 14 }; // the line's grip is in the middle
    const page = await visit.open([site], { hash: planAddress(plan) });
    await page.getByRole('button', { name: 'Compare' }).click();
    await visit.full();
    const [x, y] = await visit.placeOnPlan([18.3, 5.7], plan);
    expect(RED(await visit.colourAt(x - 22, y)), 'left of the line: taken').toBe(true);
    expect(GREEN(await visit.colourAt(x + 22, y)), 'right of it: free').toBe(true);
    await page.getByRole('slider', { name: 'Line between before and after' }).press('Home');
    await visit.full();
    expect(GREEN(await visit.colourAt(x - 22, y)), 'with the line at the edge all is after').toBe(true);
  });

  it('filters and finds spaces, and tells of them', async () => {
    const page = await visit.open([site]);
    await page.getByRole('button', { name: /^Vacant/ }).click();
    // As text, since a list that has not been painted yet has no inner text.
    expect(await page.locator('.space .id').allTextContents()).toEqual(['S2', 'S6', 'N3', 'N6']);
    await page.getByRole('searchbox').fill('s2');
    await page.keyboard.press('Enter');
    await visit.full();
    const card = await page.locator('.card').innerText();
    for (const text of ['Space S2', 'Vacant', 'new: was occupied', '913 rays passed through it', '97 %', '1 change in 2 dates']) expect(card).toContain(text);
    await page.getByRole('searchbox').fill('no such thing');
    await page.keyboard.press('Enter');
    expect(await page.locator('#search-answer').innerText()).toContain('Nothing of that name');
  });

  it('finds a voxel by its id', async () => {
    const page = await visit.open([site]);
    const id = textOfId(idOfVoxel([243, 12, 0]));
    await page.getByRole('searchbox').fill(id);
    await page.keyboard.press('Enter');
    await page.getByText('Normal', { exact: true }).waitFor();
    expect(await page.locator('.card').innerText()).toContain(id);
  });

  it('measures a distance', async () => {
    const plan = { target: [22, 0, 0], height: 10 }; // a pixel is 1.5 cm
    const page = await visit.open([site], { hash: planAddress(plan) });
    await page.getByRole('button', { name: 'Measure a distance' }).click();
    for (const place of [[17.5, -1], [20.5, 3]]) { // beside the card
      const [x, y] = await visit.placeOnPlan(place, plan);
      await page.mouse.click(x, y);
    }
    await page.locator('.distance').waitFor();
    expect(Math.abs(Number.parseFloat(await page.locator('.distance').innerText()) - 5)).toBeLessThan(0.06);
  });

  it('restores the view when one goes back', async () => {
    const page = await visit.open([site]);
    const pose = () => page.evaluate(() => window.vdbmap.statistics().pose);
    const before = await pose();
    await page.locator('[data-space=S4]').click();
    await page.selectOption('#colour', 'height');
    await visit.full();
    expect((await pose()).eye).not.toEqual(before.eye);
    await page.goBack();
    await page.goBack();
    await visit.full();
    const after = await pose();
    for (const part of ['eye', 'target']) after[part].forEach((x, i) => expect(Math.abs(x - before[part][i])).toBeLessThan(0.011));
    expect(await page.locator('.card').isHidden()).toBe(true);
    expect(await page.locator('#colour').inputValue()).toBe('color');
  });

  it('opens as it was shared', async () => {
    const page = await visit.open([site], { hash: '#camera=plan&eye=10,0,20&target=10,0,0&colour=height&epoch=1&space=S1&filter=occupied' });
    expect(await page.locator('#epoch').getAttribute('aria-valuetext')).toBe('March 2023');
    expect(await page.locator('.card h2').innerText()).toBe('Space S1');
    expect(await page.getByRole('radio', { name: 'Plan' }).isChecked()).toBe(true);
    expect(await page.getByRole('button', { name: /^Occupied/ }).getAttribute('aria-pressed')).toBe('true');
  });

  it('is moved by keys alone', async () => {
    const page = await visit.open([site]);
    const pose = () => page.evaluate(() => window.vdbmap.statistics().pose);
    const start = await pose();
    await page.locator('canvas').focus();
    for (const key of ['ArrowUp', 'Shift+ArrowLeft', '+']) await page.keyboard.press(key);
    const moved = await pose();
    expect(moved.eye).not.toEqual(start.eye);
    await page.keyboard.press('2');
    await visit.full();
    const standing = await pose();
    expect(standing.mode).toBe('walk');
    // The ground is the top of voxels 0 or 1, 10 or 20 cm high; a walker's eyes are 1.7 m above it.
    expect(standing.eye[2]).toBeGreaterThan(1.75);
    expect(standing.eye[2]).toBeLessThan(3.6);
    await page.keyboard.down('ArrowUp');
    await expect.poll(async () => { const { eye } = await pose(); return Math.hypot(eye[0] - standing.eye[0], eye[1] - standing.eye[1]); }, { timeout: 20_000 }).toBeGreaterThan(0.3);
    await page.keyboard.up('ArrowUp');
    await page.keyboard.press('3');
    expect((await pose()).mode).toBe('plan');
    await page.keyboard.press('?');
    expect(await page.getByRole('dialog').isVisible()).toBe(true);
    await page.keyboard.press('Escape');
    expect(await page.getByRole('dialog').isVisible()).toBe(false);
  });

  it('says that a tile is missing and shows the rest', async () => {
    let isBroken = true;
    const page = await visit.open([site], { server: { isMissing: (path) => isBroken && /tiles\/0_1_0\./.test(path) } });
    const alert = page.locator('.failure');
    await alert.waitFor();
    expect(await alert.innerText()).toContain('could not be loaded. The rest is shown.');
    const before = (await page.evaluate(() => window.vdbmap.statistics())).voxels;
    expect(before).toBeGreaterThan(100_000);
    isBroken = false;
    await page.getByRole('button', { name: 'Try again' }).click();
    await expect.poll(async () => (await page.evaluate(() => window.vdbmap.statistics())).voxels, { timeout: 30_000 }).toBeGreaterThan(before);
    await visit.full();
    expect(await alert.isHidden()).toBe(true);
  });

  it('keeps within its budget of memory', async () => {
    const page = await visit.open([site], { hash: '?memory=8#camera=orbit&eye=5,-4,6&target=15,0,0' });
    const { cachedBytes, voxels } = await page.evaluate(() => window.vdbmap.statistics());
    expect(voxels).toBeGreaterThan(0);
    expect(cachedBytes).toBeLessThan(12 * 2 ** 20);
  });
});

describe('Page without', () => {
  it('a site says that there is none', async () => {
    const page = await visit.open([], { wait: false });
    await page.getByRole('alert').waitFor();
    expect(await page.locator('.dead-end').innerText()).toContain('site.json: not found');
  });

  it('epochs says that there is nothing', async () => {
    const page = await visit.open([changedSite((json) => { json.epochs = []; }), site], { wait: false });
    await page.getByRole('alert').waitFor();
    expect(await page.locator('.dead-end').innerText()).toContain('There is nothing to show');
  });

  it('voxels says that the map is empty', async () => {
    const page = await visit.open([changedSite((json) => { for (const epoch of json.epochs) epoch.voxels = 0; }), site], { wait: false });
    await page.getByText('This map is empty').waitFor();
  });

  it('an EPSG code says that coordinates are local', async () => {
    const page = await visit.open([changedSite((json) => { json.epsg = null; }), site], { wait: false });
    await page.getByText('This map has local coordinates').waitFor();
    expect(await page.locator('.side header').innerText()).toContain('local coordinates');
  });

  it('colours shows heights', async () => {
    const page = await visit.open([changedSite((json) => { json.attributes.color = false; }), site]);
    expect(await page.locator('#colour').inputValue()).toBe('height');
    expect(await page.locator('#colour option[value=color]').isDisabled()).toBe(true);
  });

  it('spaces of its own place says so', async () => {
    const folder = changedSite((_json, to) => {
      const spaces = JSON.parse(readFileSync(join(site, 'spaces.json')));
      for (const space of spaces.spaces) space.polygon = space.polygon.map(([x, y, z]) => [x + 5000, y, z]);
      writeFileSync(join(to, 'spaces.json'), JSON.stringify(spaces));
    });
    const page = await visit.open([folder, site]);
    expect(await page.locator('.list').innerText()).toContain('The 12 spaces of this site lie elsewhere');
  });

  it('readable spaces still shows the map', async () => {
    const page = await visit.open([site], { server: { isMissing: (path) => path === '/spaces.json' } });
    expect(await page.locator('.list').innerText()).toContain('could not be loaded: spaces.json: not found');
  });
});

describe('Accessibility', () => {
  const SERIOUS = ['serious', 'critical'];
  const faults = async (page) => {
    await page.evaluate(axe.source);
    const { violations } = await page.evaluate(() => window.axe.run());
    return violations.filter(({ impact }) => SERIOUS.includes(impact)).map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(' ')}`);
  };

  for (const [name, options] of [['wide and light', {}], ['wide and dark', { media: { colorScheme: 'dark' } }], ['narrow', { size: { width: 390, height: 844 } }], ['narrow and dark', { size: { width: 390, height: 844 }, media: { colorScheme: 'dark' } }]]) {
    it(`has no serious fault, ${name}`, async () => {
      const page = await visit.open([site], { ...options, hash: '#camera=orbit&eye=5,-4,6&target=15,0,0&space=S2&before=1&epoch=2&colour=change' });
      expect(await faults(page)).toEqual([]);
      await page.keyboard.press('Escape');
      await page.keyboard.press('?');
      expect(await faults(page)).toEqual([]);
      await page.keyboard.press('Escape');
      if (!options.size) return;
      await page.getByRole('button', { name: 'Show the list of spaces' }).click();
      expect(await faults(page)).toEqual([]);
    });
  }
});

