// SPDX-License-Identifier: GPL-3.0-or-later
import { defineConfig } from 'vitest/config';
import GoogleTestReporter from './reporter.mjs';

export default defineConfig({
  test: {
    include: ['unit/*_test.mjs', 'browser/*_test.mjs'],
    reporters: ['default', new GoogleTestReporter()],
    fileParallelism: false, // one browser at a time: it draws in software, on all cores
    testTimeout: 90_000,
    hookTimeout: 120_000,
  },
});
