// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/survey_frame.h"

#include <algorithm>

#include "vdbmap/core/nearest_rotation.h"
#include "vdbmap/core/voxel.h"

namespace vdbmap::simulator {
namespace {

constexpr double kCellSize = 2;  // [m]
constexpr double kPassGap = 15;  // [s] after which a survey comes back
constexpr std::size_t kMostPoints = 4000;
constexpr std::size_t kFewestPoints = 100;

VoxelId cell_of(const Eigen::Vector3d& point) { return id_of_voxel(voxel_of_point(point, 1 / kCellSize)); }

// A point of a scan and a pass that saw the place.
struct Sighting {
  double time;
  Eigen::Vector3d point;
  Eigen::Vector3d measured;
};

// The longest run of sightings without a gap between their times.
std::pair<std::size_t, std::size_t> longest_pass(const std::vector<Sighting>& sightings) {
  std::pair<std::size_t, std::size_t> longest = {0, 0};
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= sightings.size(); ++i) {
    if (i < sightings.size() && sightings[i].time - sightings[i - 1].time < kPassGap) continue;
    if (i - begin > longest.second - longest.first) longest = {begin, i};
    begin = i;
  }
  return longest;
}

// The rotation and shift of least squares (Umeyama 1991, without his scale).
Eigen::Isometry3d fit(const std::vector<Sighting>& sightings) {
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  for (const Sighting& sighting : sightings) {
    from += sighting.point;
    to += sighting.measured;
  }
  from /= static_cast<double>(sightings.size());
  to /= static_cast<double>(sightings.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Sighting& sighting : sightings) {
    covariance += (sighting.measured - to) * (sighting.point - from).transpose();
  }
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = nearest_rotation(covariance);
  motion.translation() = to - motion.linear() * from;
  return motion;
}

}  // namespace

void SurveyFrame::add(const Eigen::Vector3d& true_point, const Eigen::Vector3d& measured, double time) {
  std::vector<Visit>& visits = cells_[cell_of(true_point)];
  if (visits.empty() || time - visits.back().last_time > kPassGap) visits.push_back({time, time});
  Visit& visit = visits.back();
  visit.last_time = time;
  visit.sum += measured - true_point;
  visit.count += 1;
}

std::optional<Eigen::Isometry3d> SurveyFrame::survey_from_scene(const std::vector<Eigen::Vector3d>& points) const {
  std::vector<Sighting> sightings;
  const std::size_t step = 1 + points.size() / kMostPoints;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const auto cell = cells_.find(cell_of(points[i]));
    if (cell == cells_.end()) continue;
    for (const Visit& visit : cell->second) {
      sightings.push_back({(visit.first_time + visit.last_time) / 2, points[i], points[i] + visit.sum / visit.count});
    }
  }
  std::ranges::stable_sort(sightings, {}, &Sighting::time);
  const auto [begin, end] = longest_pass(sightings);
  if (end - begin < kFewestPoints) return std::nullopt;
  return fit(
      {sightings.begin() + static_cast<std::ptrdiff_t>(begin), sightings.begin() + static_cast<std::ptrdiff_t>(end)});
}

}  // namespace vdbmap::simulator
