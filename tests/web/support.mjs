// SPDX-License-Identifier: GPL-3.0-or-later
// A plain static file server, and Debian's Chromium with a WebGL that draws in software.
import { createReadStream, existsSync, mkdtempSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { chromium } from 'playwright-core';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.glb': 'model/gltf-binary', '.wasm': 'application/wasm' };
export const BROWSER = process.env.VDBMAP_CHROMIUM ?? '/usr/bin/chromium';

/**
 * Serves folders, the first that has a file. isMissing(path): answers 404 all the same; hasRanges: whether it understands them.
 * Returns { url, requests, close }; requests: each path with the bytes of its answer.
 */
export async function serve(folders, { isMissing = () => false, hasRanges = true } = {}) {
  const requests = [];
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname)).replace(/\/$/, '/index.html');
    const file = folders.map((folder) => join(folder, path)).find((candidate) => existsSync(candidate) && statSync(candidate).isFile());
    if (!file || isMissing(path)) {
      requests.push({ path, bytes: 0 });
      response.writeHead(404).end();
      return;
    }
    const { size } = statSync(file);
    const range = hasRanges ? /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '') : null;
    const [start, end] = range ? [Number(range[1]), Number(range[2])] : [0, size - 1];
    const headers = { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream', 'content-length': end - start + 1 };
    if (range) headers['content-range'] = `bytes ${start}-${end}/${size}`;
    requests.push({ path, bytes: end - start + 1 });
    response.writeHead(range ? 206 : 200, headers);
    createReadStream(file, { start, end }).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { url: `http://127.0.0.1:${server.address().port}/`, requests, close: () => new Promise((resolve) => { server.close(resolve); server.closeAllConnections(); }) };
}

/** Chromium without a window and without a network. */
export async function openBrowser() {
  return chromium.launchPersistentContext(mkdtempSync(join(tmpdir(), 'vdbmap-chromium-')), {
    executablePath: BROWSER,
    headless: true,
    viewport: { width: 1280, height: 800 },
    permissions: ['clipboard-read', 'clipboard-write'],
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync', '--enable-precise-memory-info'],
  });
}
