// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/channel_codes.h"

#include <algorithm>
#include <cmath>

namespace vdbmap {

std::string_view covariance_problem(const openvdb::Vec3f& diagonal, const openvdb::Vec3f& off_diagonal,
                                    double voxel_size) {
  if (!is_finite(diagonal) || !is_finite(off_diagonal)) return "covariance is not finite";
  const double least_variance = -1e-6 * voxel_size * voxel_size;
  const bool is_negative = std::min({diagonal.x(), diagonal.y(), diagonal.z()}) < least_variance;
  return is_negative ? "variance is negative" : "";
}

openvdb::Vec3f mean_offset_of(const VoxelRecord& record, double voxel_size) {
  const VoxelIndex origin(0, 0, 0);
  const Eigen::Vector3d offset = mean_of(record, origin, voxel_size) - center_of_voxel(origin, voxel_size);
  return openvdb::Vec3f(offset.cast<float>().eval().data());
}

void set_mean_offset(VoxelRecord& record, const openvdb::Vec3f& offset, double voxel_size) {
  for (int axis = 0; axis < 3; ++axis) {
    const double share = offset[axis] / voxel_size + 0.5;
    record.mean_code[axis] = static_cast<std::uint16_t>(std::clamp(share * kMeanSteps, 0.0, kMeanSteps - 1.0));
  }
}

openvdb::Vec3f color_value_of(const VoxelRecord& record) {
  return openvdb::Vec3f(color_of(record).cast<float>().eval().data());
}

void set_color_value(VoxelRecord& record, const openvdb::Vec3f& linear_rgb) {
  set_color(record, {linear_rgb.x(), linear_rgb.y(), linear_rgb.z()});
}

openvdb::Vec3f normal_value_of(const VoxelRecord& record) {
  return openvdb::Vec3f(normal_of(record).cast<float>().eval().data());
}

void set_normal_value(VoxelRecord& record, const openvdb::Vec3f& normal) {
  Eigen::Vector3d direction(normal.x(), normal.y(), normal.z());
  if (direction.z() < 0) direction = -direction;
  // A code has a sign for each component even where it is 0; decoded, that is a negative zero.
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0 && std::signbit(direction[axis])) direction[axis] = -1e-12 * direction.norm();
  }
  set_normal(record, direction);
}

float planarity_value_of(const VoxelRecord& record) { return static_cast<float>(planarity_of(record)); }

void set_planarity_value(VoxelRecord& record, float planarity) {
  record.planarity_code = static_cast<std::uint8_t>(std::lround(std::clamp(planarity, 0.0f, 1.0f) * 255.0f));
}

}  // namespace vdbmap
