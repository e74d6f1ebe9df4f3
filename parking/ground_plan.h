// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// A plane over the plan: height = at_origin + slope . place.
struct GroundPlane {
  double at_origin = 0;                              ///< [m] at the place `origin`
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();

  double height_at(const Eigen::Vector2d& place) const { return at_origin + slope.dot(place - origin); }
};

/// Where the ground of a labelled level lies, and what stands on it: a table of squares of 0.5 m.
class GroundPlan {
 public:
  static constexpr double kSquare = 0.5;  ///< [m]

  /// Of a level with SemanticKITTI's labels. Throws std::invalid_argument where it has none.
  explicit GroundPlan(const VoxelLevel& level);

  /// Mean height [m, local frame] of the ground in the square of a place.
  std::optional<double> height_at(const Eigen::Vector2d& place) const;

  /// Median height of the squares with ground within a distance [m] of a place; nothing where there are none.
  std::optional<double> height_near(const Eigen::Vector2d& place, double reach) const;

  /// The plane through the ground within a distance [m] of a rectangle; level where the ground is seen in few places.
  std::optional<GroundPlane> plane_around(const Eigen::Vector2d& center, double reach) const;

  /// Whether something that is neither ground nor vehicle stands in the square of a place, 0.3 to 2 m above `ground`.
  bool is_blocked(const Eigen::Vector2d& place, double ground) const;

 private:
  struct Square {
    double sum = 0;  // of heights of ground
    std::uint32_t count = 0;
    std::vector<float> obstacles;  // heights of what is neither ground nor vehicle
  };

  const Square* find(std::int64_t x, std::int64_t y) const;
  std::vector<Eigen::Vector3d> ground_within(const Eigen::Vector2d& place, double reach) const;

  std::unordered_map<std::uint64_t, Square> squares_;
};

}  // namespace vdbmap::parking
