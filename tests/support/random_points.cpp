// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/random_points.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

namespace vdbmap::test {
namespace {

PointCloud selected(const PointCloud& cloud, const std::vector<std::size_t>& numbers) {
  PointCloud selection;
  for (const std::size_t i : numbers) {
    selection.positions.push_back(cloud.positions[i]);
    if (!cloud.colors.empty()) selection.colors.push_back(cloud.colors[i]);
    if (!cloud.intensities.empty()) selection.intensities.push_back(cloud.intensities[i]);
    if (!cloud.labels.empty()) selection.labels.push_back(cloud.labels[i]);
  }
  return selection;
}

}  // namespace

Eigen::Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  const double z = normal(random);
  return Eigen::Vector3d(x, y, z).normalized();
}

Eigen::Isometry3d random_motion(double distance, double angle_deg, std::mt19937& random) {
  const Eigen::Vector3d shift = distance * random_direction(random);
  const Eigen::Vector3d axis = random_direction(random);
  return Eigen::Translation3d(shift) * Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, axis);
}

std::vector<Eigen::Vector3d> random_points(std::size_t count, const Eigen::AlignedBox3d& box, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = share(random);
    const double y = share(random);
    const double z = share(random);
    points.emplace_back(box.min() + box.sizes().cwiseProduct(Eigen::Vector3d(x, y, z)));
  }
  return points;
}

PointCloud random_cloud(std::size_t count, const Eigen::AlignedBox3d& box, unsigned seed) {
  PointCloud cloud;
  cloud.positions = random_points(count, box, seed);
  std::mt19937 random(seed + 1);
  std::uniform_int_distribution<int> code(0, 65535);
  for (std::size_t i = 0; i < count; ++i) {
    const auto channel = [&] { return static_cast<std::uint16_t>(code(random)); };
    cloud.colors.push_back({channel(), channel(), channel()});
    cloud.intensities.push_back(static_cast<float>(code(random)) / 256.0f);
    cloud.labels.push_back(static_cast<std::uint16_t>(code(random) % 4));  // one of them kNoLabel
  }
  return cloud;
}

std::vector<VoxelIndex> random_voxels(std::size_t count, std::int32_t low, std::int32_t high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int32_t> index(low, high);
  std::set<VoxelIndex> seen;
  std::vector<VoxelIndex> voxels;
  while (voxels.size() < count) {
    const std::int32_t x = index(random);
    const std::int32_t y = index(random);
    const VoxelIndex voxel(x, y, index(random));
    if (seen.insert(voxel).second) voxels.push_back(voxel);
  }
  return voxels;
}

PointCloud shuffled(const PointCloud& cloud, unsigned seed) {
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  return selected(cloud, order);
}

PointCloud part_of(const PointCloud& cloud, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> numbers(end - begin);
  std::iota(numbers.begin(), numbers.end(), begin);
  return selected(cloud, numbers);
}

}  // namespace vdbmap::test
