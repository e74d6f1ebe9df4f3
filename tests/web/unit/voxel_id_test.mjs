// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { centreOfVoxel, idOfVoxel, isAddressable, parseVoxelId, textOfId, voxelOfId, voxelOfPoint } from '../../../tools/web/src/data/voxel_id.ts';

const LIMIT = 2 ** 20;

describe('VoxelId', () => {
  // The same values as in tests/vdbmap/core/voxel_id_test.cpp.
  it('has twenty-one bits an axis, counted from the lowest index', () => {
    expect(idOfVoxel([-LIMIT, -LIMIT, -LIMIT])).toBe(0n);
    expect(idOfVoxel([-LIMIT, -LIMIT, -LIMIT + 1])).toBe(1n);
    expect(idOfVoxel([-LIMIT, -LIMIT + 1, -LIMIT])).toBe(1n << 21n);
    expect(idOfVoxel([-LIMIT + 1, -LIMIT, -LIMIT])).toBe(1n << 42n);
  });

  it('round-trips at the limits and anywhere', () => {
    for (const voxel of [[-LIMIT, -LIMIT, -LIMIT], [LIMIT - 1, LIMIT - 1, LIMIT - 1], [0, 0, 0], [-1, 1, -1], [123456, -654321, 77]]) expect(voxelOfId(idOfVoxel(voxel))).toEqual(voxel);
  });

  it('is written as sixteen lower-case digits', () => {
    expect(textOfId(0n)).toBe('0000000000000000');
    expect(textOfId(0xabcn)).toBe('0000000000000abc');
    expect(textOfId(idOfVoxel([LIMIT - 1, LIMIT - 1, LIMIT - 1]))).toBe('7fffffffffffffff');
  });

  it('is read from what it is written as, and from nothing else', () => {
    expect(parseVoxelId('7fffffffffffffff')).toBe(0x7fffffffffffffffn);
    expect(parseVoxelId(' 0x0000000000000ABC ')).toBe(0xabcn);
    for (const text of ['', '0', '8000000000000000', '00000000000000000', '000000000000000g', '-000000000000001']) expect(parseVoxelId(text), text).toBe(null);
  });

  it('is of the voxel that holds a point, below zero too', () => {
    expect(voxelOfPoint([0.3, -0.01, 0], 0.1)).toEqual([3, -1, 0]);
    expect(voxelOfPoint([0.7, -0.1, 2.99], 0.1)).toEqual([7, -1, 29]);
    expect(centreOfVoxel([3, -1, 0], 0.1).map((x) => x.toFixed(6))).toEqual(['0.350000', '-0.050000', '0.050000']);
  });

  it('exists within 104 km', () => {
    expect(isAddressable([LIMIT - 1, 0, -LIMIT])).toBe(true);
    expect(isAddressable([LIMIT, 0, 0])).toBe(false);
  });
});
