// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/vehicle_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "vdbmap/core/voxel_groups.h"

namespace vdbmap::parking {
namespace {

constexpr std::int32_t kGroupReach = 6;    // [voxels] of 0.1 m
constexpr double kShortestVehicle = 1.5;   // [m]
constexpr double kHighestVehicle = 4.5;    // [m]
constexpr std::size_t kNumDirections = 8;  // in which a length is measured

// Extent of a group of voxels along some directions on the ground, and upwards.
class Extent {
 public:
  Extent() {
    low_.fill(std::numeric_limits<double>::infinity());
    high_.fill(-std::numeric_limits<double>::infinity());
  }

  void add(const Eigen::Vector3d& point) {
    for (std::size_t i = 0; i < kNumDirections; ++i) {
      const double angle = std::numbers::pi * static_cast<double>(i) / kNumDirections;
      add(i, std::cos(angle) * point.x() + std::sin(angle) * point.y());
    }
    add(kNumDirections, point.z());
  }

  double length() const {
    double longest = 0;
    for (std::size_t i = 0; i < kNumDirections; ++i) longest = std::max(longest, high_[i] - low_[i]);
    return longest;
  }

  double height() const { return high_[kNumDirections] - low_[kNumDirections]; }

 private:
  void add(std::size_t i, double value) {
    low_[i] = std::min(low_[i], value);
    high_[i] = std::max(high_[i], value);
  }

  std::array<double, kNumDirections + 1> low_{};
  std::array<double, kNumDirections + 1> high_{};
};

}  // namespace

void drop_what_is_no_vehicle(const VoxelLevel& level, std::span<const SurfaceClass> second,
                             std::vector<SurfaceClass>& classes) {
  std::vector<std::uint8_t> is_vehicle(level.size());
  std::ranges::transform(classes, is_vehicle.begin(),
                         [](SurfaceClass surface) { return surface == SurfaceClass::kVehicle ? 1 : 0; });
  std::vector<Eigen::Vector3d> centers(level.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    if (is_vehicle[number] != 0) centers[number] = center_of_voxel(voxel, level.voxel_size());
  });
  for (const VoxelGroup& group : find_groups(level, is_vehicle, kGroupReach)) {
    Extent extent;
    for (const std::size_t number : group) extent.add(centers[number]);
    if (extent.length() >= kShortestVehicle && extent.height() <= kHighestVehicle) continue;
    for (const std::size_t number : group) classes[number] = second[number];
  }
}

}  // namespace vdbmap::parking
