// SPDX-License-Identifier: GPL-3.0-or-later
// node laz_perf.js FILE.laz RECORDS: decodes a LAZ file with laz-perf and writes its point records, as they would stand in the LAS file; prints
// how many points, and how many of them a second.
const fs = require('fs');
const { createLazPerf } = require('laz-perf');

async function main() {
  const [file, recordsFile] = process.argv.slice(2);
  const lazPerf = await createLazPerf();
  const compressed = fs.readFileSync(file);
  const compressedAt = lazPerf._malloc(compressed.byteLength);
  lazPerf.HEAPU8.set(compressed, compressedAt);
  const laszip = new lazPerf.LASZip();
  laszip.open(compressedAt, compressed.byteLength);

  const count = laszip.getCount();
  const length = laszip.getPointLength();
  const recordAt = lazPerf._malloc(length);
  const records = Buffer.alloc(count * length);
  const start = process.hrtime.bigint();
  for (let i = 0; i < count; ++i) {
    laszip.getPoint(recordAt);
    records.set(lazPerf.HEAPU8.subarray(recordAt, recordAt + length), i * length);
  }
  const seconds = Number(process.hrtime.bigint() - start) * 1e-9;
  fs.writeFileSync(recordsFile, records);
  console.log(`${count} points, ${(count / seconds / 1e6).toFixed(2)} million a second`);
}

main().catch((error) => {
  console.error(String(error));
  process.exit(1);
});
