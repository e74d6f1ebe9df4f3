// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/vehicle_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

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

// Walks from a voxel of a vehicle to all that hang together with it.
class GroupFinder {
 public:
  GroupFinder(const VoxelLevel& level, const std::vector<SurfaceClass>& classes)
      : level_(level), classes_(classes), finder_(level), is_met_(level.size(), 0) {}

  bool is_met(std::size_t number) const { return is_met_[number] != 0; }

  // Numbers of the group's voxels.
  const std::vector<std::size_t>& group_of(const VoxelIndex& voxel, std::size_t number, Extent& extent) {
    group_.clear();
    to_visit_.clear();
    meet(voxel, number);
    while (!to_visit_.empty()) {
      const VoxelIndex next = to_visit_.back();
      to_visit_.pop_back();
      finder_.for_each_around(next, kGroupReach, [&](const VoxelIndex& near, const VoxelRecord& record) {
        const auto found = static_cast<std::size_t>(&record - level_.records().data());
        if (classes_[found] == SurfaceClass::kVehicle && !is_met(found)) meet(near, found);
      });
      extent.add(center_of_voxel(next, level_.voxel_size()));
    }
    return group_;
  }

 private:
  void meet(const VoxelIndex& voxel, std::size_t number) {
    is_met_[number] = 1;
    group_.push_back(number);
    to_visit_.push_back(voxel);
  }

  const VoxelLevel& level_;
  const std::vector<SurfaceClass>& classes_;
  VoxelFinder finder_;
  std::vector<std::uint8_t> is_met_;
  std::vector<std::size_t> group_;
  std::vector<VoxelIndex> to_visit_;
};

}  // namespace

void drop_what_is_no_vehicle(const VoxelLevel& level, std::span<const SurfaceClass> second,
                             std::vector<SurfaceClass>& classes) {
  std::vector<std::size_t> dropped;
  GroupFinder groups(level, classes);
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    if (classes[number] != SurfaceClass::kVehicle || groups.is_met(number)) return;
    Extent extent;
    const std::vector<std::size_t>& group = groups.group_of(voxel, number, extent);
    if (extent.length() < kShortestVehicle || extent.height() > kHighestVehicle) {
      dropped.insert(dropped.end(), group.begin(), group.end());
    }
  });
  for (const std::size_t number : dropped) classes[number] = second[number];
}

}  // namespace vdbmap::parking
