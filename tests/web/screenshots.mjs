// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures of tools/web/README.md: screenshots.mjs SITE_FOLDER PAGE_FOLDER OUTPUT_FOLDER [SPACE]; by default the first new space
import { join } from 'node:path';
import { openBrowser, serve } from './support.mjs';

const [site, page, output, chosen] = process.argv.slice(2);
const WIDE = { width: 1280, height: 800 };
const PICTURES = [
  { name: 'wide', size: WIDE },
  { name: 'compare_dark', size: WIDE, media: { colorScheme: 'dark' }, keys: ['c'], space: true },
  { name: 'narrow', size: { width: 390, height: 844 }, space: true },
  { name: 'plan_change', size: WIDE, keys: ['3'], colour: 'change' },
];

const server = await serve([page, site]);
const context = await openBrowser();
for (const { name, size, media = {}, keys = [], space = false, colour = null } of PICTURES) {
  const tab = await context.newPage();
  const full = async () => {
    await tab.waitForTimeout(600);
    await tab.waitForFunction(() => document.documentElement.dataset.view === 'full', null, { timeout: 120_000 });
  };
  await tab.setViewportSize(size);
  await tab.emulateMedia({ reducedMotion: 'reduce', ...media });
  await tab.goto(server.url);
  await full();
  if (space) await tab.evaluate((id) => document.querySelector(id ? `[data-space="${id}"]` : '.space:has(.new), .space')?.click(), chosen);
  for (const key of keys) await tab.keyboard.press(key);
  if (colour && !(await tab.locator(`#colour option[value=${colour}]`).isDisabled())) await tab.selectOption('#colour', colour);
  await full();
  await tab.evaluate(() => document.querySelector('.hint').remove());
  await tab.waitForTimeout(300);
  await tab.screenshot({ path: join(output, `${name}.jpg`), type: 'jpeg', quality: 82 });
  await tab.close();
}
await context.close();
await server.close();
