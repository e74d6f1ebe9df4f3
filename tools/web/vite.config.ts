// SPDX-License-Identifier: GPL-3.0-or-later
import { defineConfig } from 'vite';

export default defineConfig({
  base: './', // the page works from any folder of any server
  build: {
    target: 'es2022',
    outDir: process.env.VDBMAP_WEB_OUTPUT ?? 'dist',
    emptyOutDir: true,
    chunkSizeWarningLimit: 1500, // [kB] three.js is most of it
    modulePreload: false,
    license: { fileName: 'assets/licenses.md' }, // of what is bundled
  },
});
