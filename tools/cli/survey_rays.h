// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/core/pose_track.h"
#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/io/map_inputs.h"

namespace vdbmap::cli {

/// From where a survey's points were measured: its vehicle's way, and where the scanner is on the vehicle.
struct SurveyTrack {
  std::filesystem::path file;
  PoseTrack map_from_vehicle;
  Eigen::Vector3d scanner_in_vehicle = Eigen::Vector3d::Zero();  ///< [m] the lever arm
};

/// Reads a trajectory in map coordinates (TUM). Throws IoError where it has no times or fewer than two poses.
SurveyTrack read_survey_track(const std::filesystem::path& trajectory, const Eigen::Vector3d& scanner_in_vehicle);

/// The points of a survey with their rays, each from where the scanner was at the point's time. Points at other times
/// than the trajectory's have no ray, and are counted. Throws IoError for a file whose points have no times, and where
/// no point of it is at a time of the trajectory.
class SurveyRays {
 public:
  SurveyRays(const std::vector<MapInput>& inputs, InputOptions options, SurveyTrack track);

  /// Goes through the files once.
  void for_each(const std::function<void(const PosedCloud&)>& take);

  /// Logs how many points had no ray the last time, if any.
  void warn() const;

 private:
  std::vector<Eigen::Vector3d> origins(const PointCloud& cloud);

  const std::vector<MapInput>& inputs_;
  InputOptions options_;
  SurveyTrack track_;
  std::size_t num_points_ = 0;
  std::size_t num_without_ray_ = 0;
};

}  // namespace vdbmap::cli
