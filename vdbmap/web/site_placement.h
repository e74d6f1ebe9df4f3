// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"

namespace vdbmap {

/// Where the local frame of a map lies in the world: coordinates about the centre of the Earth (ECEF, WGS 84) where
/// the map's EPSG code is known, else the local frame itself. One thread at a time.
class SitePlacement {
 public:
  /// Throws std::invalid_argument as GeodeticTransform does.
  explicit SitePlacement(const MapFrame& frame, double geoid_offset = 0);

  bool is_on_globe() const { return transform_.has_value(); }

  /// The place of a point [m, local frame].
  Eigen::Vector3d world_of(const Eigen::Vector3d& local) const;

  /// The affine map that comes nearest to world_of() at the corners of a box, about whose centre it is made: the
  /// corners of one 128 m wide are met to less than 1 mm.
  Eigen::Affine3d world_from_local(const Eigen::AlignedBox3d& box) const;

 private:
  Eigen::Vector3d anchor_;
  std::optional<GeodeticTransform> transform_;
};

}  // namespace vdbmap
