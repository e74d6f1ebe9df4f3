// SPDX-License-Identifier: GPL-3.0-or-later
// Between map-local metres and WGS 84, by the affine of site.json: right to centimetres within some kilometres.
import { Matrix4, Vector3 } from 'three';
import type { Vector } from './voxel_id.ts';

const SEMI_MAJOR = 6378137; // [m] WGS 84
const FLATTENING = 1 / 298.257223563;
const ECCENTRICITY_2 = FLATTENING * (2 - FLATTENING);
const RADIANS = Math.PI / 180;

export interface Geographic {
  longitude: number; // [deg]
  latitude: number; // [deg]
  height: number; // [m] above the ellipsoid
}

export function ecefOfGeographic({ longitude, latitude, height }: Geographic): Vector {
  const [sinLat, cosLat] = [Math.sin(latitude * RADIANS), Math.cos(latitude * RADIANS)];
  const radius = SEMI_MAJOR / Math.sqrt(1 - ECCENTRICITY_2 * sinLat * sinLat);
  return [
    (radius + height) * cosLat * Math.cos(longitude * RADIANS),
    (radius + height) * cosLat * Math.sin(longitude * RADIANS),
    (radius * (1 - ECCENTRICITY_2) + height) * sinLat,
  ];
}

/** By iteration (Hofmann-Wellenhof et al., GPS Theory and Practice, 10.2): to 1e-9 degrees near the ground. */
export function geographicOfEcef([x, y, z]: Vector): Geographic {
  const distance = Math.hypot(x, y);
  let latitude = Math.atan2(z, distance * (1 - ECCENTRICITY_2));
  let height = 0;
  for (let i = 0; i < 6; ++i) {
    const sinLat = Math.sin(latitude);
    const radius = SEMI_MAJOR / Math.sqrt(1 - ECCENTRICITY_2 * sinLat * sinLat);
    height = distance / Math.cos(latitude) - radius;
    latitude = Math.atan2(z, distance * (1 - (ECCENTRICITY_2 * radius) / (radius + height)));
  }
  return { longitude: Math.atan2(y, x) / RADIANS, latitude: latitude / RADIANS, height };
}

export function localOfGeographic(position: Geographic, localFromEcef: readonly number[]): Vector {
  const ecef = new Vector3(...ecefOfGeographic(position));
  return ecef.applyMatrix4(new Matrix4().fromArray([...localFromEcef])).toArray();
}

export function geographicOfLocal(point: Vector, localFromEcef: readonly number[]): Geographic {
  const ecefFromLocal = new Matrix4().fromArray([...localFromEcef]).invert();
  return geographicOfEcef(new Vector3(...point).applyMatrix4(ecefFromLocal).toArray());
}
