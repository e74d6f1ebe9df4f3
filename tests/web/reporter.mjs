// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what became of each test as GoogleTest would, for tools/count_tests.sh.
import { writeFileSync } from 'node:fs';

const escape = (text) => String(text).replace(/[&<>"\n]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;', '\n': '&#10;' })[c]);

function rowOf(test) {
  const { state, errors, note } = test.result();
  const name = `name="${escape(test.name)}" classname="${escape(test.parent.name ?? 'Web')}" status="run"`;
  if (state === 'skipped') return `<testcase ${name} result="skipped">\n<skipped message="${escape(note ?? 'skipped')}"/>\n</testcase>`;
  if (state === 'passed') return `<testcase ${name} result="completed"/>`;
  return `<testcase ${name} result="completed">\n<failure message="${escape(errors?.[0]?.message ?? state)}"/>\n</testcase>`;
}

export default class GoogleTestReporter {
  onTestRunEnd(modules) {
    if (!process.env.VDBMAP_TEST_RESULTS) return;
    const rows = modules.flatMap((module) => [...module.children.allTests()].map(rowOf));
    // A file that does not even load has no tests, but errors.
    for (const module of modules) for (const error of module.errors()) rows.push(`<testcase name="${escape(module.moduleId.split('/').pop())}" classname="Web" status="run" result="completed">\n<failure message="${escape(error.message)}"/>\n</testcase>`);
    writeFileSync(process.env.VDBMAP_TEST_RESULTS, `<testsuites><testsuite name="web">\n${rows.join('\n')}\n</testsuite></testsuites>\n`);
  }
}
