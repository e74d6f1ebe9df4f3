// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/voxel_id.h"

namespace vdbmap::simulator {

/// How a survey displaced what it measured: by cells of 2 m and passes, the mean of measured minus true place.
class SurveyFrame {
 public:
  /// Takes note of a measured point [m, scene frame]; times must not decrease.
  void add(const Eigen::Vector3d& true_point, const Eigen::Vector3d& measured, double time);

  /// The rigid motion of least squares that brings points of a scan [m, scene frame] to where the pass that saw most of
  /// them has them; nothing where no pass saw a hundred of them.
  std::optional<Eigen::Isometry3d> survey_from_scene(const std::vector<Eigen::Vector3d>& points) const;

 private:
  struct Visit {
    double first_time, last_time;  // [s]
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
  };

  std::unordered_map<VoxelId, std::vector<Visit>> cells_;
};

}  // namespace vdbmap::simulator
