// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/camera_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr std::size_t kMaxSamples = 200'000;  // voxels looked at
constexpr std::size_t kMaxFitSamples = 5'000;
constexpr double kStrayShare = 0.02;     // of the voxels on each side, that do not count as part of the scene
constexpr double kOutsideShare = 0.005;  // the same where the map fills the picture
constexpr double kOrbitFieldOfViewDeg = 35;
constexpr double kOrbitElevationDeg = -33;
constexpr double kStreetFieldOfViewDeg = 68;
constexpr double kStreetElevationDeg = -13;
constexpr double kMinExtent = 1;  // [m]

std::vector<Eigen::Vector3d> some_voxels(const VoxelLevel& level, std::size_t most) {
  std::vector<Eigen::Vector3d> centers;
  const std::span<const VoxelLeaf> leaves = level.leaves();
  const std::size_t stride = level.size() / most + 1;
  for (std::size_t i = 0; i < leaves.size(); i += stride) {
    for_each_voxel(leaves[i], [&](const VoxelIndex& voxel, std::size_t) {
      centers.push_back(center_of_voxel(voxel, level.voxel_size()));
    });
  }
  return centers;
}

double quantile_of(std::vector<double> values, double share) {
  const auto place = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

double quantile(const std::vector<Eigen::Vector3d>& points, int axis, double share) {
  std::vector<double> values;
  for (const Eigen::Vector3d& point : points) values.push_back(point[axis]);
  return quantile_of(std::move(values), share);
}

double principal_heading_deg(const std::vector<Eigen::Vector3d>& points, const Eigen::AlignedBox3d& box) {
  const Eigen::Vector2d center = box.center().head<2>();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& point : points) {
    if (!box.contains(point)) continue;
    const Eigen::Vector2d offset = point.head<2>() - center;
    scatter += offset * offset.transpose();
  }
  return 0.5 * std::atan2(2 * scatter(0, 1), scatter(0, 0) - scatter(1, 1)) * kDegPerRad;
}

void check_count(std::span<const double> numbers, std::size_t least, std::size_t most, const char* names) {
  const bool are_finite = std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
  if (numbers.size() >= least && numbers.size() <= most && are_finite) return;
  throw std::invalid_argument("the camera has " + std::to_string(numbers.size()) +
                              " numbers, expected finite ones: " + names);
}

void check_elevation(double elevation_deg) {
  if (std::abs(elevation_deg) <= 90) return;
  throw std::invalid_argument("elevation of the camera is " + std::to_string(elevation_deg) +
                              " degrees, expected -90 to 90");
}

// The middle of most voxels on an axis, and how far they reach to either side [m].
std::pair<double, double> middle_and_reach(const std::vector<Eigen::Vector3d>& points, int axis, double outside_share) {
  const double low = quantile(points, axis, outside_share);
  const double high = quantile(points, axis, 1 - outside_share);
  return {(low + high) / 2, std::max(high - low, kMinExtent) / 2};
}

Camera plan_camera(const VoxelLevel& level, const SceneExtent& extent, const ImageSize& size,
                   std::span<const double> numbers) {
  constexpr double kMargin = 1.06;
  Eigen::Vector2d center;
  double width = 0;
  if (numbers.empty()) {
    const std::vector<Eigen::Vector3d> points = some_voxels(level, kMaxSamples);
    const auto [middle_x, reach_x] = middle_and_reach(points, 0, kOutsideShare);
    const auto [middle_y, reach_y] = middle_and_reach(points, 1, kOutsideShare);
    center = {middle_x, middle_y};
    width = 2 * kMargin * std::max(reach_x, reach_y * size.width / size.height);
  } else {
    check_count(numbers, 3, 3, "X,Y,WIDTH");
    center = {numbers[0], numbers[1]};
    width = numbers[2];
  }
  const double above = extent.box.max().z() + 100;  // [m] higher than stray voxels of a street
  return Camera::orthographic(map_from_camera_at({center.x(), center.y(), above}, 90, -90), width, size);
}

Camera orbit_at(const Eigen::Vector3d& center, double heading_deg, double elevation_deg, double distance,
                const ImageSize& size) {
  Eigen::Isometry3d map_from_camera = map_from_camera_at(center, heading_deg, elevation_deg);
  map_from_camera.translation() -= distance * map_from_camera.linear().col(2);
  return Camera::perspective(map_from_camera, kOrbitFieldOfViewDeg, size);
}

// Where the eye must be on one axis of the picture, `axis` of the points, for most of them to lie in the middle.
double centered_eye(const std::vector<Eigen::Vector3d>& points, int axis, double low, double high, double eye_z) {
  const auto offset_from = [&](double eye) {
    std::vector<double> slopes;
    for (const Eigen::Vector3d& point : points) {
      if (point.z() > eye_z) slopes.push_back((point[axis] - eye) / (point.z() - eye_z));
    }
    return slopes.empty() ? 0 : quantile_of(slopes, kOutsideShare) + quantile_of(slopes, 1 - kOutsideShare);
  };
  constexpr int kSteps = 30;  // each halves the range
  for (int step = 0; step < kSteps; ++step) {
    const double middle = (low + high) / 2;
    (offset_from(middle) > 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

// The nearest from which most of the map is seen, in the middle of the picture. Stray voxels all around would make a
// street a dot: some may lie outside.
//
// In the frame of the camera's axes, an eye (a, c) sees the points (x, z) with |x - a| <= t (z - c), where t is the
// tangent of half the field of view. So a - t c >= x - t z and -a - t c >= -x - t z for all of them, and the largest of
// the right sides give the nearest c; for balls of radius r around the points they grow by r sqrt(1 + t^2).
Camera fitting_orbit(const VoxelLevel& level, double heading_deg, double elevation_deg, const ImageSize& size) {
  constexpr double kMargin = 0.03;  // of the picture, on each side
  const Eigen::Matrix3d map_from_axes =
      map_from_camera_at(Eigen::Vector3d::Zero(), heading_deg, elevation_deg).linear();
  std::vector<Eigen::Vector3d> points = some_voxels(level, kMaxFitSamples);
  for (Eigen::Vector3d& point : points) point = map_from_axes.transpose() * point;

  const double tangent = (1 - 2 * kMargin) * std::tan(kOrbitFieldOfViewDeg / 2 / kDegPerRad);
  const Eigen::Vector2d tangents(tangent, tangent * size.height / size.width);
  const double radius = std::sqrt(3.0) / 2 * level.voxel_size();
  const auto farthest = [&](int axis, double sign) {
    std::vector<double> values;
    for (const Eigen::Vector3d& point : points) values.push_back(sign * point[axis] - tangents[axis] * point.z());
    return quantile_of(std::move(values), 1 - kOutsideShare) + radius * std::hypot(1, tangents[axis]);
  };
  Eigen::Vector3d eye(0, 0, std::numeric_limits<double>::infinity());
  for (const int axis : {0, 1}) {
    eye.z() = std::min(eye.z(), -(farthest(axis, 1) + farthest(axis, -1)) / (2 * tangents[axis]));
  }
  for (const int axis : {0, 1}) {
    const auto [low, high] = std::ranges::minmax(points, {}, [&](const auto& point) { return point[axis]; });
    eye[axis] = centered_eye(points, axis, low[axis], high[axis], eye.z());
  }
  return Camera::perspective(map_from_camera_at(map_from_axes * eye, heading_deg, elevation_deg), kOrbitFieldOfViewDeg,
                             size);
}

Camera orbit_camera(const VoxelLevel& level, const SceneExtent& extent, const ImageSize& size,
                    std::span<const double> numbers) {
  // The longest direction runs from left to right, a little towards the viewer.
  if (numbers.empty()) return fitting_orbit(level, extent.heading_deg + 90 - 25, kOrbitElevationDeg, size);
  check_count(numbers, 2, 3, "HEADING,ELEVATION[,DISTANCE]");
  check_elevation(numbers[1]);
  if (numbers.size() == 2) return fitting_orbit(level, numbers[0], numbers[1], size);
  return orbit_at(extent.box.center(), numbers[0], numbers[1], numbers[2], size);
}

// How much is to be seen: rays that end neither in front of the lens nor in the sky, the farther the better.
double worth_of(const RayCaster& caster, const Camera& camera) {
  constexpr double kTooNear = 4;  // [m]
  constexpr double kFar = 60;     // [m]
  constexpr int kSteps = 24;
  double worth = 0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector2d pixel((i + 0.5) * camera.size().width / kSteps, (j + 0.5) * camera.size().height / kSteps);
      const auto hit = caster.first_hit(camera.ray_through(pixel));
      if (hit) worth += hit->distance < kTooNear ? -1 : std::min(hit->distance / kFar, 1.0);
    }
  }
  return worth;
}

Camera street_at(const Eigen::Vector3d& eye, double heading_deg, const ImageSize& size) {
  return Camera::perspective(map_from_camera_at(eye, heading_deg, kStreetElevationDeg), kStreetFieldOfViewDeg, size);
}

// Places on and beside both axes of the map, with a view along them either way.
std::vector<Camera> street_cameras(const SceneExtent& extent, const ImageSize& size) {
  constexpr double kHeight = 7;  // [m] above the lowest voxels
  const double length = extent.box.sizes().head<2>().norm();
  Eigen::Vector3d middle = extent.box.center();
  middle.z() = extent.box.min().z() + kHeight;
  std::vector<Camera> cameras;
  for (const double turn_deg : {0.0, 180.0, 90.0, -90.0}) {
    const double heading = (extent.heading_deg + turn_deg) / kDegPerRad;
    const Eigen::Vector3d along(std::cos(heading), std::sin(heading), 0);
    const Eigen::Vector3d across(-along.y(), along.x(), 0);
    for (const double back : {0.35, 0.25, 0.15, 0.05}) {
      for (const double aside : {0.0, 0.04, -0.04, 0.08, -0.08, 0.12, -0.12}) {
        const Eigen::Vector3d eye = middle - back * length * along + aside * length * across;
        cameras.push_back(street_at(eye, extent.heading_deg + turn_deg, size));
      }
    }
  }
  return cameras;
}

Camera best_street_camera(const VoxelLevel& level, const SceneExtent& extent, const ImageSize& size) {
  const std::vector<Camera> cameras = street_cameras(extent, size);
  const RayCaster caster(level);
  std::vector<double> worths(cameras.size());
  parallel_for(cameras.size(), [&](std::size_t i) { worths[i] = worth_of(caster, cameras[i]); });
  const auto best = std::max_element(worths.begin(), worths.end());
  return cameras[static_cast<std::size_t>(best - worths.begin())];
}

// From behind and above the first place of the path, towards where it is some way on.
std::optional<Camera> camera_along(std::span<const Eigen::Vector3d> path, const ImageSize& size) {
  constexpr double kAhead = 15;  // [m]
  if (path.empty()) return std::nullopt;
  const auto ahead = std::find_if(
      path.begin(), path.end(), [&](const Eigen::Vector3d& place) { return (place - path.front()).norm() >= kAhead; });
  const Eigen::Vector3d way = (ahead == path.end() ? path.back() : *ahead) - path.front();
  if (way.head<2>().norm() < 1) return std::nullopt;
  const Eigen::Vector3d direction = Eigen::Vector3d(way.x(), way.y(), 0).normalized();
  const Eigen::Vector3d eye = path.front() - 9 * direction + Eigen::Vector3d(0, 0, 5);
  return street_at(eye, std::atan2(way.y(), way.x()) * kDegPerRad, size);
}

Camera perspective_camera(const VoxelLevel& level, const SceneExtent& extent, const ImageSize& size,
                          std::span<const Eigen::Vector3d> path) {
  if (const std::optional<Camera> camera = camera_along(path, size)) return *camera;
  return best_street_camera(level, extent, size);
}

Camera perspective_by(std::span<const double> numbers, const ImageSize& size) {
  check_count(numbers, 5, 6, "X,Y,Z,HEADING,ELEVATION[,FIELD_OF_VIEW]");
  check_elevation(numbers[4]);
  const double field_of_view_deg = numbers.size() == 6 ? numbers[5] : kStreetFieldOfViewDeg;
  return Camera::perspective(map_from_camera_at({numbers[0], numbers[1], numbers[2]}, numbers[3], numbers[4]),
                             field_of_view_deg, size);
}

}  // namespace

SceneExtent scene_extent(const VoxelLevel& level) {
  const std::vector<Eigen::Vector3d> points = some_voxels(level, kMaxSamples);
  if (points.empty()) throw std::invalid_argument("the map has no voxels to look at");
  SceneExtent extent;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [middle, reach] = middle_and_reach(points, axis, kStrayShare);
    extent.box.min()[axis] = middle - reach;
    extent.box.max()[axis] = middle + reach;
  }
  extent.heading_deg = principal_heading_deg(points, extent.box);
  return extent;
}

Camera choose_camera(const VoxelLevel& level, View view, const ImageSize& size, std::span<const double> numbers,
                     std::span<const Eigen::Vector3d> path) {
  if (view == View::kPerspective && !numbers.empty()) return perspective_by(numbers, size);
  const SceneExtent extent = scene_extent(level);
  if (view == View::kPlan) return plan_camera(level, extent, size, numbers);
  if (view == View::kOrbit) return orbit_camera(level, extent, size, numbers);
  return perspective_camera(level, extent, size, path);
}

}  // namespace vdbmap
