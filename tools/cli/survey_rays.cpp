// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/survey_rays.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

std::string times_text(const PointCloud& cloud, const PoseTrack& track) {
  const auto [first, last] = std::ranges::minmax(cloud.times);
  return fmt::format("its points are of times {:.3f} to {:.3f} s, the trajectory of {:.3f} to {:.3f} s", first, last,
                     track.first_time(), track.last_time());
}

}  // namespace

SurveyTrack read_survey_track(const std::filesystem::path& trajectory, const Eigen::Vector3d& scanner_in_vehicle) {
  const Trajectory poses = read_trajectory(trajectory);
  if (poses.times.empty()) throw IoError::malformed(trajectory, "has no times, expected a TUM file");
  try {
    return {trajectory, PoseTrack(poses.map_from_scan, poses.times), scanner_in_vehicle};
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(trajectory, error.what());
  }
}

SurveyRays::SurveyRays(const std::vector<MapInput>& inputs, InputOptions options, SurveyTrack track)
    : inputs_(inputs), options_(std::move(options)), track_(std::move(track)) {}

void SurveyRays::for_each(const std::function<void(const PosedCloud&)>& take) {
  num_points_ = 0;
  num_without_ray_ = 0;
  read_inputs(inputs_, options_, [&](const InputPoints& points) {
    const std::filesystem::path& file = inputs_[points.index].scan.file;
    if (points.cloud.times.empty()) {
      throw IoError::malformed(file, "its points have no times, which rays along a trajectory need");
    }
    const std::size_t before = num_without_ray_;
    const std::vector<Eigen::Vector3d> from = origins(points.cloud);
    if (num_without_ray_ - before == points.cloud.size() && points.is_whole) {
      throw IoError::malformed(file, times_text(points.cloud, track_.map_from_vehicle));
    }
    num_points_ += points.cloud.size();
    take({points.cloud, Eigen::Isometry3d::Identity(), from});
    return UnreachablePoints{};
  });
}

void SurveyRays::warn() const {
  if (num_without_ray_ == 0) return;
  spdlog::warn("{}: {} of {} points are of times without a pose and have no ray", track_.file.string(),
               num_without_ray_, num_points_);
}

std::vector<Eigen::Vector3d> SurveyRays::origins(const PointCloud& cloud) {
  // A ray without length says nothing.
  std::vector<Eigen::Vector3d> origins = cloud.positions;
  std::vector<std::uint8_t> is_missing(cloud.size());
  parallel_for(
      cloud.size(),
      [&](std::size_t i) {
        const std::optional<Eigen::Isometry3d> pose = track_.map_from_vehicle.at(cloud.times[i]);
        if (pose) origins[i] = *pose * track_.scanner_in_vehicle;
        is_missing[i] = !pose;
      },
      4096);
  num_without_ray_ += static_cast<std::size_t>(std::ranges::count(is_missing, 1));
  return origins;
}

}  // namespace vdbmap::cli
