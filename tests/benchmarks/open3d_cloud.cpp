// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/open3d_cloud.h"

namespace vdbmap::benchmarks {

open3d::geometry::PointCloud open3d_cloud(const PointCloud& cloud) {
  open3d::geometry::PointCloud converted;
  converted.points_ = cloud.positions;
  converted.colors_.reserve(cloud.colors.size());
  for (const Rgb16& color : cloud.colors) {
    converted.colors_.push_back(Eigen::Vector3d(color.r, color.g, color.b) / 65535);
  }
  return converted;
}

open3d::geometry::PointCloud open3d_cloud(const VoxelLevel& level) {
  open3d::geometry::PointCloud converted;
  converted.points_.reserve(level.size());
  converted.normals_.reserve(level.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t record) {
    converted.points_.push_back(mean_of(level.records()[record], voxel, level.voxel_size()));
    converted.normals_.push_back(normal_of(level.records()[record]));
  });
  return converted;
}

}  // namespace vdbmap::benchmarks
