// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/relative_error.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace vdbmap::registration {
namespace {

/// The scans with a true pose, and how far along the true path each of them is.
struct TruePath {
  std::vector<std::size_t> scans;
  std::vector<double> distances;  ///< [m]
};

TruePath path_of(const Trajectory& truth) {
  TruePath path;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!truth.map_from_scan[i]) continue;
    const Eigen::Vector3d here = truth.map_from_scan[i]->translation();
    path.distances.push_back(path.scans.empty() ? 0 : path.distances.back() + (here - before).norm());
    path.scans.push_back(i);
    before = here;
  }
  return path;
}

// The first place of the path more than `length` beyond `first`.
std::optional<std::size_t> end_of_segment(const TruePath& path, std::size_t first, double length) {
  const auto end = std::upper_bound(path.distances.begin() + static_cast<std::ptrdiff_t>(first), path.distances.end(),
                                    path.distances[first] + length);
  if (end == path.distances.end()) return std::nullopt;
  return static_cast<std::size_t>(end - path.distances.begin());
}

Eigen::Isometry3d motion(const Trajectory& trajectory, std::size_t first, std::size_t last) {
  return trajectory.map_from_scan[first]->inverse() * *trajectory.map_from_scan[last];
}

RelativeError error_over(double length, const Trajectory& estimate, const Trajectory& truth, const TruePath& path,
                         std::size_t start_step) {
  RelativeError error;
  error.length = length;
  std::vector<double> translations;
  std::vector<double> rotations_deg;
  for (std::size_t first = 0; first < path.scans.size(); first += start_step) {
    const std::optional<std::size_t> last = end_of_segment(path, first, length);
    if (!last) break;
    const std::size_t first_scan = path.scans[first];
    const std::size_t last_scan = path.scans[*last];
    if (!estimate.map_from_scan[first_scan] || !estimate.map_from_scan[last_scan]) {
      ++error.num_missing;
      continue;
    }
    const PoseError segment = pose_error(motion(estimate, first_scan, last_scan), motion(truth, first_scan, last_scan));
    translations.push_back(segment.translation);
    rotations_deg.push_back(segment.rotation_deg);
    error.driven += path.distances[*last] - path.distances[first];
  }
  error.num_segments = translations.size();
  if (error.num_segments > 0) error.driven /= static_cast<double>(error.num_segments);
  error.translation = summarize(std::move(translations));
  error.rotation_deg = summarize(std::move(rotations_deg));
  return error;
}

}  // namespace

std::vector<RelativeError> relative_errors(const Trajectory& estimate, const Trajectory& truth,
                                           std::span<const double> lengths, std::size_t start_step) {
  if (estimate.size() != truth.size()) {
    throw std::invalid_argument("cannot compare " + std::to_string(estimate.size()) + " estimated poses with " +
                                std::to_string(truth.size()) + " true ones");
  }
  if (start_step == 0) throw std::invalid_argument("step between segments is 0, expected 1 or more");
  const TruePath path = path_of(truth);
  std::vector<RelativeError> errors;
  for (const double length : lengths) {
    if (!(length > 0)) {
      throw std::invalid_argument("length of a segment is " + std::to_string(length) + " m, expected above 0");
    }
    const RelativeError error = error_over(length, estimate, truth, path, start_step);
    if (error.num_segments > 0) errors.push_back(error);
  }
  return errors;
}

KittiScore kitti_score(std::span<const RelativeError> errors) {
  KittiScore score;
  for (const RelativeError& error : errors) {
    const auto count = static_cast<double>(error.num_segments);
    score.translation_percent += count * error.translation_percent();
    score.rotation_deg_per_m += count * error.rotation_deg_per_m();
    score.num_segments += error.num_segments;
  }
  const double count = score.num_segments > 0 ? static_cast<double>(score.num_segments) : 0;
  score.translation_percent /= count;  // nan without a segment
  score.rotation_deg_per_m /= count;
  return score;
}

}  // namespace vdbmap::registration
