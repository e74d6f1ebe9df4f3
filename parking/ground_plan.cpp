// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/ground_plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

#include "parking/segmentation/surface_class.h"

namespace vdbmap::parking {
namespace {

constexpr double kLowestObstacle = 0.3, kHighestObstacle = 2.0;  // [m] above the ground
constexpr std::size_t kFewestOfPlane = 12;                       // squares
constexpr double kSteepest = 0.2;
constexpr double kOffPlane = 0.25;  // [m] squares farther from the median are walls or another storey

std::int64_t square_of(double coordinate) {
  return static_cast<std::int64_t>(std::floor(coordinate / GroundPlan::kSquare));
}

std::uint64_t key_of(std::int64_t x, std::int64_t y) {
  return static_cast<std::uint64_t>(x) << 32 ^ (static_cast<std::uint64_t>(y) & 0xffffffff);
}

double median_height(const std::vector<Eigen::Vector3d>& places) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& place : places) heights.push_back(place.z());
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

}  // namespace

GroundPlan::GroundPlan(const VoxelLevel& level) {
  const std::vector<std::int32_t>& labels = level.channels().labels;
  if (labels.size() != level.size()) throw std::invalid_argument("a level without labels has no ground");
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const std::optional<SurfaceClass> surface = surface_class_of(labels[number]);
    if (!surface || *surface == SurfaceClass::kVehicle) return;
    const Eigen::Vector3d mean = mean_of(level.records()[number], voxel, level.voxel_size());
    Square& square = squares_[key_of(square_of(mean.x()), square_of(mean.y()))];
    if (*surface != SurfaceClass::kGround) {
      square.obstacles.push_back(static_cast<float>(mean.z()));
    } else {
      square.sum += mean.z();
      ++square.count;
    }
  });
}

const GroundPlan::Square* GroundPlan::find(std::int64_t x, std::int64_t y) const {
  const auto found = squares_.find(key_of(x, y));
  return found == squares_.end() ? nullptr : &found->second;
}

std::optional<double> GroundPlan::height_at(const Eigen::Vector2d& place) const {
  const Square* square = find(square_of(place.x()), square_of(place.y()));
  if (!square || square->count == 0) return std::nullopt;
  return square->sum / square->count;
}

std::vector<Eigen::Vector3d> GroundPlan::ground_within(const Eigen::Vector2d& place, double reach) const {
  std::vector<Eigen::Vector3d> found;
  for (std::int64_t x = square_of(place.x() - reach); x <= square_of(place.x() + reach); ++x) {
    for (std::int64_t y = square_of(place.y() - reach); y <= square_of(place.y() + reach); ++y) {
      const Square* square = find(x, y);
      if (!square || square->count == 0) continue;
      const Eigen::Vector2d middle((static_cast<double>(x) + 0.5) * kSquare, (static_cast<double>(y) + 0.5) * kSquare);
      if ((middle - place).norm() <= reach) found.emplace_back(middle.x(), middle.y(), square->sum / square->count);
    }
  }
  return found;
}

std::optional<double> GroundPlan::height_near(const Eigen::Vector2d& place, double reach) const {
  const std::vector<Eigen::Vector3d> places = ground_within(place, reach);
  return places.empty() ? std::nullopt : std::optional(median_height(places));
}

std::optional<GroundPlane> GroundPlan::plane_around(const Eigen::Vector2d& center, double reach) const {
  std::vector<Eigen::Vector3d> places = ground_within(center, reach);
  if (places.empty()) return std::nullopt;
  const double median = median_height(places);
  GroundPlane plane{median, center};
  std::erase_if(places, [&](const Eigen::Vector3d& p) {
    return std::abs(p.z() - median) > kOffPlane + kSteepest / 2 * (p.head<2>() - center).norm();
  });
  if (places.size() < kFewestOfPlane) return plane;
  Eigen::Matrix3d normal = 1e-3 * Eigen::Matrix3d::Identity();  // places on one line say nothing of the slope across
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : places) {
    const Eigen::Vector3d row(1, p.x() - center.x(), p.y() - center.y());
    normal += row * row.transpose();
    right += row * (p.z() - median);
  }
  const Eigen::Vector3d solved = normal.ldlt().solve(right);
  if (solved.tail<2>().norm() > kSteepest) return plane;
  plane.at_origin += solved[0];
  plane.slope = solved.tail<2>();
  return plane;
}

bool GroundPlan::is_blocked(const Eigen::Vector2d& place, double ground) const {
  const Square* square = find(square_of(place.x()), square_of(place.y()));
  return square && std::ranges::any_of(square->obstacles, [&](float height) {
           return height > ground + kLowestObstacle && height < ground + kHighestObstacle;
         });
}

}  // namespace vdbmap::parking
