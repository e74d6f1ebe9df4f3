// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include <Eigen/Core>

namespace vdbmap {

/// A projected coordinate system and WGS 84. Throws std::invalid_argument for coordinates that are not finite or that
/// the projection cannot reach.
class Projection {
 public:
  virtual ~Projection() = default;

  /// Metres in the unit of the heights.
  virtual double height_unit() const = 0;

  /// Longitude, latitude [deg] of easting and northing; the height counts for nothing, but must be finite.
  virtual Eigen::Vector2d to_degrees(const Eigen::Vector3d& place) const = 0;

  /// The inverse of to_degrees().
  virtual Eigen::Vector2d from_degrees(const Eigen::Vector3d& degrees) const = 0;

  /// X, Y, Z about the centre of the Earth [m] of longitude, latitude [deg] and height above the ellipsoid [m].
  virtual Eigen::Vector3d to_ecef(const Eigen::Vector3d& degrees) const = 0;
};

/// What is done by PROJ. It stands in a module of its own, loaded when the first system is asked for: Debian's PROJ
/// brings 45 libraries along, those of the network mostly, and every command would start 10 ms later.
struct ProjectionModule {
  /// Throws std::invalid_argument for what is no projected system that PROJ knows.
  std::unique_ptr<Projection> (*make)(int epsg);
};

/// Loads the module at the first call. Throws std::runtime_error where it cannot be found.
const ProjectionModule& projection_module();

}  // namespace vdbmap
