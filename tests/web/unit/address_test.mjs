// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { readAddress, writeAddress } from '../../../tools/web/src/data/address.ts';
import { isEmpty, readSite } from '../../../tools/web/src/data/site.ts';
import { readDetails } from '../../../tools/web/src/data/voxel_details.ts';
import { roundLength } from '../../../tools/web/src/interface/legend.ts';
import { formatCount, formatMetres } from '../../../tools/web/src/interface/format.ts';

describe('Address', () => {
  const view = { pose: { mode: 'orbit', eye: [1.25, -3, 20], target: [0, 0, 0.5] }, colour: 'height', epoch: '2', before: '1', split: 0.25, filter: 'vacant', space: 'S 1/ä&=', voxel: '40020dffffb00000' };

  it('restores what it was made of, odd names too', () => {
    expect(readAddress(writeAddress(view))).toEqual(view);
  });

  it('keeps centimetres and leaves out what is as ever', () => {
    expect(writeAddress({ pose: { ...view.pose, eye: [1.2345, 0, 0] }, filter: 'all' })).toBe('#camera=orbit&eye=1.23,0,0&target=0,0,0.5');
  });

  it('passes over what makes no sense', () => {
    const nonsense = readAddress('#camera=fly&eye=1,2&target=a,b,c&colour=smell&split=7&filter=x&epoch=9');
    expect(Object.entries(nonsense).filter(([, value]) => value !== undefined)).toEqual([['epoch', '9']]);
    expect(readAddress('#camera=plan&eye=1,2,1e99&target=0,0,0').pose).toBe(undefined);
    expect(readAddress('').pose).toBe(undefined);
  });
});

describe('Site', () => {
  it('is refused with its reason where it is none', () => {
    expect(() => readSite({})).toThrow('not a site of vdbmap');
    expect(() => readSite(null)).toThrow('not a site of vdbmap');
    expect(() => readSite({ format: 'vdbmap-site', version: 2 })).toThrow('version 2; this page reads version 1');
    expect(() => readSite({ format: 'vdbmap-site', version: 1 })).toThrow('no list of epochs');
    expect(() => readSite({ format: 'vdbmap-site', version: 1, epochs: [{ id: '1' }] })).toThrow('epoch 1 has no tileset');
  });

  it('is empty without voxels', () => {
    const site = (voxels) => readSite({ format: 'vdbmap-site', version: 1, epochs: [{ id: '1', tileset: 't.json', voxels }] });
    expect(isEmpty(site(0))).toBe(true);
    expect(isEmpty(site(1))).toBe(false);
  });
});

describe('Details', () => {
  it('are 44 bytes, little endian', () => {
    const bytes = Buffer.alloc(88);
    bytes.writeUInt32LE(70000, 44);
    [0.01, 0.02, 0.03, 1e-4, 2e-4, 3e-4, 4e-5, 5e-5, 6e-5].forEach((value, i) => bytes.writeFloatLE(value, 48 + 4 * i));
    bytes.writeUInt8(200, 84);
    [-127, 0, 0].forEach((value, i) => bytes.writeInt8(value, 85 + i));
    const details = readDetails(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + 88), 44);
    expect(details).toMatchObject({ count: 70000, label: 200, normal: [-1, 0, 0] });
    expect(details.mean.map((x) => x.toFixed(4))).toEqual(['0.0100', '0.0200', '0.0300']);
    expect(details.covariance.map((x) => x.toFixed(6))).toEqual(['0.000100', '0.000200', '0.000300', '0.000040', '0.000050', '0.000060']);
  });

  it('have no normal where it is zero, and are refused cut short', () => {
    expect(readDetails(new ArrayBuffer(44)).normal).toBe(null);
    expect(() => readDetails(new ArrayBuffer(43))).toThrow(RangeError);
  });
});

describe('Numbers', () => {
  it('read as people write them', () => {
    expect(formatCount(1234567).replaceAll(/\s/g, ' ')).toBe('1 234 567');
    expect([0.5, 12.34, 2500].map(formatMetres)).toEqual(['0.50 m', '12.3 m', '2.50 km']);
    expect([0.7, 3.9, 7, 49, 120].map((x) => Number(roundLength(x).toPrecision(3)))).toEqual([0.5, 2, 5, 20, 100]);
  });
});
