// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the tests of the page: run.mjs PAGE_FOLDER RESULTS.xml [COMMAND]. Where something is missing they skip, and the results say what.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [page, results, command] = process.argv.slice(2);
const browser = process.env.VDBMAP_CHROMIUM ?? '/usr/bin/chromium';
const vitest = join(here, 'node_modules/vitest/vitest.mjs');

function missing() {
  if (!existsSync(vitest)) return 'needs the npm packages of tests/web: npm ci --prefix tests/web';
  if (!existsSync(browser)) return 'needs Chromium (Debian package chromium)';
  return null;
}

mkdirSync(dirname(results), { recursive: true });
const reason = missing();
if (reason) {
  writeFileSync(results, `<testsuites><testsuite name="web">\n<testcase name="Page" classname="Web" status="run" result="skipped">\n<skipped message="${reason}"/>\n</testcase>\n</testsuite></testsuites>\n`);
  console.log(`skipped: ${reason}`);
} else {
  const env = { ...process.env, VDBMAP_WEB_PAGE: page, VDBMAP_TEST_RESULTS: results, VDBMAP_COMMAND: command ?? '' };
  process.exitCode = spawnSync(process.execPath, [vitest, 'run'], { cwd: here, stdio: 'inherit', env }).status ?? 1;
}
