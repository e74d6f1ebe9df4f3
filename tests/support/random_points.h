// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/voxel.h"

namespace vdbmap::test {

/// Three values of next() as a vector, z first: in what order arguments are made each compiler decides for itself, and
/// another order is another test.
template <typename Next>
Eigen::Vector3d vector_of(const Next& next) {
  Eigen::Vector3d vector;
  for (int axis = 2; axis >= 0; --axis) vector[axis] = next();
  return vector;
}

/// A unit vector, every direction equally likely.
Eigen::Vector3d random_direction(std::mt19937& random);

/// A motion of exactly `distance` [m] in any direction and exactly `angle_deg` about any axis.
Eigen::Isometry3d random_motion(double distance, double angle_deg, std::mt19937& random);

/// Points spread evenly over the box.
std::vector<Eigen::Vector3d> random_points(std::size_t count, const Eigen::AlignedBox3d& box, unsigned seed);

/// Points spread evenly over the box, each with a colour and an intensity of its own.
PointCloud random_cloud(std::size_t count, const Eigen::AlignedBox3d& box, unsigned seed);

/// Different voxels spread evenly over [low, high] on each axis, in random order.
std::vector<VoxelIndex> random_voxels(std::size_t count, std::int32_t low, std::int32_t high, unsigned seed);

/// The points of a cloud with their attributes in another order.
PointCloud shuffled(const PointCloud& cloud, unsigned seed);

/// The points [begin, end) of a cloud with their attributes.
PointCloud part_of(const PointCloud& cloud, std::size_t begin, std::size_t end);

}  // namespace vdbmap::test
