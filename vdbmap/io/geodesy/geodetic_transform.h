// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include <Eigen/Core>

namespace vdbmap {

class Projection;

/// Places of a projected coordinate system on the globe, by PROJ. Offline: grids of datum shifts are used where they
/// are installed, else the best transformation without them.
///
/// Original coordinates are easting, northing and height in the units of the system (metres, mostly); heights are above
/// the geoid or the ellipsoid, and `geoid_offset` is what makes the latter of them. The vertical part of a compound
/// system gives the unit of the heights and nothing else.
///
/// An object may be used by one thread at a time; objects in different threads do not disturb each other. Making one
/// takes some milliseconds: one a thread, not one a point.
class GeodeticTransform {
 public:
  /// `geoid_offset` [m]: height of the ellipsoid's zero below that of the heights given (the geoid's undulation).
  /// Throws std::invalid_argument for EPSG codes that PROJ does not know, for systems that are not projected (degrees,
  /// coordinates about the centre of the Earth, heights alone), and for an offset that is not finite.
  explicit GeodeticTransform(int epsg, double geoid_offset = 0);
  ~GeodeticTransform();
  GeodeticTransform(GeodeticTransform&&) noexcept;
  GeodeticTransform& operator=(GeodeticTransform&&) noexcept;

  /// Longitude [deg], latitude [deg] and height above the ellipsoid [m] in WGS 84. Throws std::invalid_argument for
  /// coordinates that are not finite or that the projection cannot reach.
  Eigen::Vector3d to_wgs84(const Eigen::Vector3d& original) const;

  /// The inverse of to_wgs84(). Throws as it does.
  Eigen::Vector3d from_wgs84(const Eigen::Vector3d& lon_lat_height) const;

  /// X, Y, Z about the centre of the Earth [m], WGS 84. Throws as to_wgs84().
  Eigen::Vector3d to_ecef(const Eigen::Vector3d& original) const;

 private:
  std::unique_ptr<Projection> projection_;
  double geoid_offset_;  // [m]
};

}  // namespace vdbmap
