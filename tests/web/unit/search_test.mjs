// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { ecefOfGeographic, geographicOfEcef, geographicOfLocal, localOfGeographic } from '../../../tools/web/src/data/geodesy.ts';
import { parseNumbers, search } from '../../../tools/web/src/data/search.ts';
import { readSpaces } from '../../../tools/web/src/data/spaces.ts';
import { idOfVoxel, textOfId } from '../../../tools/web/src/data/voxel_id.ts';
import { ecefFromLocal, inverse, PLACE } from '../fixture/site.mjs';

const CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0]];
const site = { voxelSize: 0.1, epsg: 25832, anchor: [550000, 5800000, 50], geoidOffset: 43, bounds: { min: [0, -12, 0], max: [50, 12, 10] }, localFromEcef: inverse(ecefFromLocal(PLACE)) };
const spaces = readSpaces({ spaces: [{ id: 'S1', polygon: CORNERS, states: [] }, { id: '12', polygon: CORNERS, states: [] }] });
const find = (text) => search(text, site, spaces);

describe('Search', () => {
  it('finds spaces whatever the case', () => {
    expect(find(' s1 ')).toMatchObject({ kind: 'space', space: { id: 'S1' } });
    expect(find('12')).toMatchObject({ kind: 'space', space: { id: '12' } });
  });

  it('finds voxels by their id, within the map only', () => {
    expect(find(textOfId(idOfVoxel([101, -20, 3])))).toMatchObject({ kind: 'voxel', id: idOfVoxel([101, -20, 3]) });
    expect(find(textOfId(idOfVoxel([100000, 0, 0])))).toEqual({ kind: 'outside' });
  });

  it('finds places in coordinates of the map, in degrees and in local metres', () => {
    expect(find('550012.5, 5799998')).toEqual({ kind: 'place', point: [12.5, -2, 0], as: 'map' });
    expect(find('12.5 -2 1')).toEqual({ kind: 'place', point: [12.5, -2, 1], as: 'local' });
    const place = find(`${PLACE.latitude}, ${PLACE.longitude}`);
    expect(place).toMatchObject({ kind: 'place', as: 'geographic' });
    expect(Math.hypot(place.point[0], place.point[1])).toBeLessThan(1e-6);
  });

  it('says of other places that they are outside, and of other words that they are nothing', () => {
    expect(find('400000 5800000')).toEqual({ kind: 'outside' });
    for (const text of ['', 'car', '1 2 3 4', 'x y']) expect(find(text), text).toEqual({ kind: 'nothing' });
    expect(parseNumbers('52.3° ; 9.7°')).toEqual([52.3, 9.7]);
  });
});

describe('Geodesy', () => {
  it('knows the axes of the ellipsoid', () => {
    expect(ecefOfGeographic({ longitude: 0, latitude: 0, height: 10 })).toEqual([6378147, 0, 0]);
    expect(ecefOfGeographic({ longitude: 0, latitude: 90, height: 0 })[2]).toBeCloseTo(6356752.3142, 3);
  });

  it('agrees with PROJ on a place in Hanover', () => {
    // echo 52.3478 9.7342 93 | cs2cs -f %.4f EPSG:4979 EPSG:4978
    const [x, y, z] = ecefOfGeographic({ longitude: 9.7342, latitude: 52.3478, height: 93 });
    expect([x, y, z].map((v) => v.toFixed(4))).toEqual(['3848235.7438', '660155.3602', '5026610.3288']);
  });

  it('comes back from where it went', () => {
    for (const [latitude, longitude, height] of [[52.3478, 9.7342, 93], [-33.9, 151.2, 0], [70, -150, 2000]]) {
      const back = geographicOfEcef(ecefOfGeographic({ latitude, longitude, height }));
      expect(back.latitude).toBeCloseTo(latitude, 9);
      expect(back.longitude).toBeCloseTo(longitude, 9);
      expect(back.height).toBeCloseTo(height, 4);
    }
    const local = localOfGeographic(geographicOfLocal([31, -7, 4], site.localFromEcef), site.localFromEcef);
    [31, -7, 4].forEach((x, axis) => expect(local[axis]).toBeCloseTo(x, 4));
  });
});
