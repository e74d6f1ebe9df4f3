// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { standingPlace } from '../../../tools/web/src/scene/standing_place.ts';

/** Ground of 20 m by 20 m, and boxes of voxels [x, y, z, from ... to]. */
function* place(...boxes) {
  for (let x = 0; x < 20; x += 0.2) for (let y = 0; y < 20; y += 0.2) yield [x, y, 0.05];
  for (const [x0, y0, z0, x1, y1, z1] of boxes) for (let x = x0; x < x1; x += 0.2) for (let y = y0; y < y1; y += 0.2) for (let z = z0; z < z1; z += 0.2) yield [x, y, z];
}

describe('StandingPlace', () => {
  it('is right there on open ground, and beneath a roof', () => {
    for (const voxels of [place(), place([0, 0, 2.5, 20, 20, 2.8])]) {
      const [x, y, z] = standingPlace(voxels, [10, 10, 0]);
      expect(Math.hypot(x - 10, y - 10)).toBeLessThan(0.8);
      expect(z).toBeCloseTo(0.05);
    }
  });

  it('is beside what stands in the way', () => {
    const [x, y] = standingPlace(place([8, 8, 0, 12, 12, 1.5]), [9, 10, 0]);
    expect(Math.max(8 - x, x - 12, 8 - y, y - 12)).toBeGreaterThan(0.3);
    expect(x).toBeLessThan(8);
  });

  it('is nowhere without ground', () => {
    expect(standingPlace([], [0, 0, 0])).toBe(null);
    expect(standingPlace(place(), [100, 100, 0])).toBe(null);
  });
});
