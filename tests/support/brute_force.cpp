// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/brute_force.h"

#include <cmath>
#include <numeric>

namespace vdbmap::test {
namespace {

using Vector3l = Eigen::Matrix<long double, 3, 1>;
using Matrix3l = Eigen::Matrix<long double, 3, 3>;

}  // namespace

PointsByVoxel points_by_voxel(std::span<const Eigen::Vector3d> points, double voxel_size,
                              const Eigen::Vector3d& anchor) {
  const long double voxels_per_tile = std::round(64.0L / voxel_size);
  PointsByVoxel voxels;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto index = [&](int axis) {
      const long double local = static_cast<long double>(points[i][axis]) - anchor[axis];
      return static_cast<std::int32_t>(std::floor(local * voxels_per_tile / 64));
    };
    voxels[{index(0), index(1), index(2)}].push_back(i);
  }
  return voxels;
}

Moments two_pass_moments(std::span<const Eigen::Vector3d> points, std::span<const std::size_t> numbers,
                         const Eigen::Vector3d& origin) {
  Vector3l sum = Vector3l::Zero();
  for (const std::size_t i : numbers) sum += points[i].cast<long double>() - origin.cast<long double>();
  const Vector3l mean = sum / static_cast<long double>(numbers.size());

  Matrix3l scatter = Matrix3l::Zero();
  for (const std::size_t i : numbers) {
    const Vector3l offset = points[i].cast<long double>() - origin.cast<long double>() - mean;
    scatter += offset * offset.transpose();
  }
  return {static_cast<std::int64_t>(numbers.size()), mean.cast<double>(), scatter.cast<double>()};
}

Moments two_pass_moments(std::span<const Eigen::Vector3d> points) {
  std::vector<std::size_t> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return two_pass_moments(points, numbers);
}

}  // namespace vdbmap::test
