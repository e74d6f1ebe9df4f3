// SPDX-License-Identifier: GPL-3.0-or-later
// node tileset_check.mjs MODULES SITE TILESET.json: reads a tileset of a site with programs of others, which lie in the folder MODULES
// (node_modules): 3d-tiles-tools walks through it, tilesets in it included; gltf-validator judges every glTF file as it is, and once more
// after meshoptimizer's decoder has decompressed it, since the validator cannot look into compressed data. Prints how many tiles and points
// were read; ends with 1 where anything is wrong, and says what.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const [modules, site, tilesetName] = process.argv.slice(2);
const require = createRequire(path.join(path.resolve(modules), 'index.js'));
const validator = require('gltf-validator');
const { MeshoptDecoder } = require('meshoptimizer');
const { ResourceResolvers, TilesetTraverser } = require('3d-tiles-tools');

const chunksOf = (glb) => {
  const jsonLength = glb.readUInt32LE(12);
  const binAt = 20 + jsonLength;
  return { json: JSON.parse(glb.toString('utf8', 20, binAt)), bin: glb.subarray(binAt + 8, binAt + 8 + glb.readUInt32LE(binAt)) };
};

const padded = (bytes, fill) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, fill)]);

const glbOf = (json, bin) => {
  const text = padded(Buffer.from(JSON.stringify(json)), 0x20);
  const header = Buffer.alloc(20);
  header.write('glTF');
  [2, 20 + text.length + 8 + bin.length, text.length, 0x4e4f534a].forEach((number, i) => header.writeUInt32LE(number, 4 + 4 * i));
  const binHeader = Buffer.alloc(8);
  [bin.length, 0x004e4942].forEach((number, i) => binHeader.writeUInt32LE(number, 4 * i));
  return Buffer.concat([header, text, binHeader, bin]);
};

// The same file without EXT_meshopt_compression.
const decompressed = (glb) => {
  const { json, bin } = chunksOf(glb);
  const views = json.bufferViews.map((view) => {
    const packed = view.extensions.EXT_meshopt_compression;
    const bytes = new Uint8Array(packed.count * packed.byteStride);
    const source = bin.subarray(packed.byteOffset, packed.byteOffset + packed.byteLength);
    MeshoptDecoder.decodeGltfBuffer(bytes, packed.count, packed.byteStride, source, packed.mode);
    delete view.extensions;
    view.buffer = 0;
    return Buffer.from(bytes);
  });
  const whole = padded(Buffer.concat(views), 0);
  json.buffers = [{ byteLength: whole.length }];
  json.extensionsUsed = json.extensionsUsed.filter((name) => name !== 'EXT_meshopt_compression');
  json.extensionsRequired = json.extensionsRequired.filter((name) => name !== 'EXT_meshopt_compression');
  return glbOf(json, whole);
};

// Errors and warnings; infos only say which extensions the validator does not know.
const findings = async (glb) => {
  const report = await validator.validateBytes(new Uint8Array(glb), { maxIssues: 20 });
  return { info: report.info, list: report.issues.messages.filter((issue) => issue.severity <= 1) };
};

const contentsOf = async () => {
  const contents = [];
  const resolver = ResourceResolvers.createFileResourceResolver(path.resolve(site));
  const traverser = new TilesetTraverser(path.resolve(site), resolver, { depthFirst: true, traverseExternalTilesets: true });
  const tileset = JSON.parse(fs.readFileSync(path.join(site, tilesetName)));
  await traverser.traverse(tileset, async (tile) => {
    for (const content of tile.getFinalContents()) {
      if (content.uri.endsWith('.glb')) contents.push(path.join('tiles', path.basename(content.uri)));
    }
    return true;
  });
  return contents;
};

const main = async () => {
  await MeshoptDecoder.ready;
  const wrong = [];
  const contents = await contentsOf();
  let points = 0;
  for (const name of contents) {
    const glb = fs.readFileSync(path.join(site, name));
    const plain = await findings(decompressed(glb));
    points += plain.info.totalVertexCount;
    for (const issue of [...(await findings(glb)).list, ...plain.list]) wrong.push(`${name}: ${issue.code} ${issue.message} ${issue.pointer}`);
  }
  console.log(JSON.stringify({ tiles: contents.length, points }));
  if (wrong.length > 0) throw new Error(wrong.slice(0, 20).join('\n'));
};

main().catch((error) => {
  console.error(String(error));
  process.exit(1);
});
