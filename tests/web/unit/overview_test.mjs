// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { overviewOf, overviewPose } from '../../../tools/web/src/data/overview.ts';

/** A street 100 m long and 10 m wide, turned by an angle about a place. */
function street(angle, [x0, y0]) {
  const points = [];
  for (let u = -50; u <= 50; ++u) for (let v = -5; v <= 5; ++v) points.push([x0 + u * Math.cos(angle) - v * Math.sin(angle), y0 + u * Math.sin(angle) + v * Math.cos(angle), 0]);
  return points;
}

describe('Overview', () => {
  it('finds the street whichever way it runs', () => {
    for (const angle of [0, 0.7, 1.5, 2.4]) {
      const { centre, axis, length, width } = overviewOf(street(angle, [30, -20]));
      expect(Math.abs(Math.sin(axis - angle))).toBeLessThan(1e-6);
      expect(centre[0]).toBeCloseTo(30, 6);
      expect(centre[1]).toBeCloseTo(-20, 6);
      expect(length).toBeCloseTo(84, 0); // 8 % are left out at each end
      expect(width).toBeGreaterThan(7.5);
    }
  });

  it('is not misled by a few points far away', () => {
    const { centre, length } = overviewOf([...street(0, [0, 0]), [3000, 0, 0], [2000, 10, 0], [2500, 0, 5]]);
    expect(Math.hypot(centre[0], centre[1])).toBeLessThan(2);
    expect(length).toBeLessThan(95);
  });

  it('is seen from above, farther on narrow screens', () => {
    const overview = overviewOf(street(0, [0, 0]));
    const distance = (aspect) => { const { eye, target } = overviewPose(overview, aspect); return Math.hypot(...eye.map((x, i) => x - target[i])); };
    expect(overviewPose(overview, 1.5).eye[2]).toBeGreaterThan(20);
    expect(distance(0.5)).toBeGreaterThan(2 * distance(1.6));
    expect(overviewOf([[1, 2, 3]]).centre).toEqual([1, 2, 3]);
  });
});
