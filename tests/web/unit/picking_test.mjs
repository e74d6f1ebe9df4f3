// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { Ray, Vector3 } from '../../../tools/web/node_modules/three/build/three.module.js';
import { nameInMiddle, NO_VOXEL, PICK_REACH, PICK_SIDE, surfaceOf } from '../../../tools/web/src/scene/picking.ts';

/** A picture of names with those given as [row, column, name]. */
function picture(...names) {
  const words = new Uint32Array(PICK_SIDE * PICK_SIDE).fill(NO_VOXEL);
  for (const [row, column, name] of names) words[row * PICK_SIDE + column] = name;
  return new Uint8Array(words.buffer);
}

describe('Picking', () => {
  it('takes what is in the middle, or what is nearest within three pixels', () => {
    expect(nameInMiddle(picture([PICK_REACH, PICK_REACH, 7], [PICK_REACH, PICK_REACH + 1, 8]))).toBe(7);
    expect(nameInMiddle(picture([PICK_REACH - 2, PICK_REACH, 5], [PICK_REACH, PICK_REACH + 3, 6]))).toBe(5);
    expect(nameInMiddle(picture([PICK_REACH - 4, PICK_REACH, 5]))).toBe(NO_VOXEL);
    expect(nameInMiddle(picture([PICK_REACH, PICK_REACH, 0xfffffffe]))).toBe(0xfffffffe);
  });

  it('finds where a ray enters a cube', () => {
    const down = new Ray(new Vector3(0.33, 0.47, 10), new Vector3(0, 0, -1));
    surfaceOf([3, 4, 0], 0.1, down).forEach((x, axis) => expect(x).toBeCloseTo([0.33, 0.47, 0.1][axis], 9));
    const aslant = new Ray(new Vector3(-1, 0.5, 0.5), new Vector3(1, 0, 0));
    surfaceOf([0, 0, 0], 1, aslant).forEach((x, axis) => expect(x).toBeCloseTo([0, 0.5, 0.5][axis], 9));
  });

  it('gives the centre of a cube that a ray just misses', () => {
    surfaceOf([0, 0, 0], 1, new Ray(new Vector3(-1, 1.01, 0.5), new Vector3(1, 0, 0))).forEach((x) => expect(x).toBeCloseTo(0.5, 9));
  });
});
