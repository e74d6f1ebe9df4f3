// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "parking/segmentation/surface_class.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::test {

/// A street of ground and of bodies that are boxes with a lower bonnet, labelled with SemanticKITTI's classes.
class LabelledStreet {
 public:
  /// A body of 4.4 x 1.8 m, of which only what `is_seen`(along, across, height) says is there.
  template <typename IsSeen>
  void add_body(const Eigen::Vector2d& middle, double heading, const IsSeen& is_seen) {
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading)), across(-along.y(), along.x());
    for (double a = -2.2; a <= 2.2001; a += 0.05) {
      for (double c = -0.9; c <= 0.9001; c += 0.05) {
        const double top = a > 1.0 ? 0.9 : 1.4;
        for (double z = 0.2; z <= top + 0.001; z += 0.05) {
          const bool is_skin = std::abs(a) > 2.14 || std::abs(c) > 0.84 || z > top - 0.06;
          if (!is_skin || !is_seen(a, c, z)) continue;
          const Eigen::Vector2d place = middle + a * along + c * across;
          add({place.x(), place.y(), z}, parking::SurfaceClass::kVehicle);
        }
      }
    }
  }

  void add_body(const Eigen::Vector2d& middle, double heading) {
    add_body(middle, heading, [](double, double, double) { return true; });
  }

  template <typename IsSeen>
  void add_ground(double low, double high, const IsSeen& is_seen) {
    for (double x = low; x < high; x += 0.09) {
      for (double y = low; y < high; y += 0.09) {
        if (is_seen(x, y)) add({x, y, 0.03}, parking::SurfaceClass::kGround);
      }
    }
  }

  /// Points of a level rectangle.
  void add_patch(const Eigen::Vector3d& low, const Eigen::Vector2d& size, parking::SurfaceClass surface) {
    for (double x = 0; x < size.x(); x += 0.09) {
      for (double y = 0; y < size.y(); y += 0.09) add(low + Eigen::Vector3d(x, y, 0), surface);
    }
  }

  const PointCloud& cloud() const { return cloud_; }

  /// The level of 10 cm alone, anchored at (0, 0, 0), or both usual ones with another anchor.
  VoxelMap map() const {
    VoxelMap map = fine_map_of(labelled());
    map.label_scheme = LabelScheme::kSemanticKitti;
    return map;
  }
  VoxelMap map_at(const Eigen::Vector3d& anchor, int epsg) const {
    PointCloud cloud = labelled();
    for (Eigen::Vector3d& point : cloud.positions) point += anchor;
    BuildOptions options = anchored(anchor);
    options.epsg = epsg;
    VoxelMap map = build_map(cloud, options);
    map.label_scheme = LabelScheme::kSemanticKitti;
    return map;
  }

  void add(const Eigen::Vector3d& point, parking::SurfaceClass surface) {
    cloud_.positions.push_back(point);
    classes_.push_back(surface);
  }

 private:
  PointCloud labelled() const {
    PointCloud cloud = cloud_;
    for (const parking::SurfaceClass surface : classes_) {
      cloud.labels.push_back(static_cast<std::uint16_t>(parking::semantic_kitti_label(surface)));
    }
    return cloud;
  }

  PointCloud cloud_;
  std::vector<parking::SurfaceClass> classes_;
};

}  // namespace vdbmap::test
