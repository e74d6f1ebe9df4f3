// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_record.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <openvdb/math/QuantizedUnitVec.h>

namespace vdbmap {
namespace {

constexpr double kCodeMax = 65535.0;

std::uint16_t code_of_share(double share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * kCodeMax));
}

}  // namespace

Eigen::Matrix3d covariance_of(const VoxelRecord& record) {
  const auto& c = record.covariance;
  Eigen::Matrix3d covariance;
  covariance << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  return covariance;
}

Moments moments_of(const VoxelRecord& record, const VoxelIndex& voxel, double voxel_size) {
  Moments moments;
  moments.count = record.count;
  moments.mean = mean_of(record, voxel, voxel_size);
  moments.scatter = covariance_of(record) * std::max(0.0, record.count - 1.0);
  return moments;
}

Eigen::Vector3d normal_of(const VoxelRecord& record) {
  const openvdb::Vec3s normal = openvdb::math::QuantizedUnitVec::unpack(record.normal_code);
  return {normal.x(), normal.y(), normal.z()};
}

Eigen::Vector3d color_of(const VoxelRecord& record) {
  const auto& code = record.color_code;
  return {code[0] / kCodeMax, code[1] / kCodeMax, code[2] / kCodeMax};
}

void set_moments(VoxelRecord& record, const Moments& moments, const VoxelIndex& voxel, double voxel_size) {
  const Eigen::Vector3d share = (moments.mean - corner_of_voxel(voxel, voxel_size)) / voxel_size;
  for (int axis = 0; axis < 3; ++axis) {
    record.mean_code[axis] = static_cast<std::uint16_t>(std::clamp(share[axis] * kMeanSteps, 0.0, kMeanSteps - 1.0));
  }

  constexpr std::int64_t kMaxCount = std::numeric_limits<std::int32_t>::max();  // the file's type
  record.count = static_cast<std::uint32_t>(std::min(moments.count, kMaxCount));

  const Eigen::Matrix3d covariance = moments.covariance();
  record.covariance = {round_covariance(covariance(0, 0)), round_covariance(covariance(1, 1)),
                       round_covariance(covariance(2, 2)), round_covariance(covariance(0, 1)),
                       round_covariance(covariance(0, 2)), round_covariance(covariance(1, 2))};
}

float round_covariance(double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return std::bit_cast<float>((bits + 0x80u) & ~0xffu);
}

void set_normal(VoxelRecord& record, const Eigen::Vector3d& normal) {
  // The code keeps three signs and |x|, |y| as 126ths of |x|+|y|+|z|. OpenVDB's pack() rounds down, which tilts every
  // normal towards z. Here all three are rounded to the nearest, and where they do not add up to 126 the one farthest
  // from its value gives way: the nearest code, without bias.
  const Eigen::Array3d scaled = normal.array().abs() * (126.0 / normal.lpNorm<1>());
  Eigen::Array3d steps = scaled.round();
  const double excess = steps.sum() - 126;
  if (excess != 0) {
    Eigen::Index farthest = 0;
    ((steps - scaled) * excess).maxCoeff(&farthest);
    steps[farthest] -= excess;
  }
  auto x = static_cast<unsigned>(steps.x());
  auto y = static_cast<unsigned>(steps.y());
  if (x > 63) {
    x = 127 - x;
    y = 127 - y;
  }
  const unsigned signs =
      (normal.x() < 0 ? 0x8000u : 0u) | (normal.y() < 0 ? 0x4000u : 0u) | (normal.z() < 0 ? 0x2000u : 0u);
  record.normal_code = static_cast<std::uint16_t>(signs | x << 7 | y);
}

void set_color(VoxelRecord& record, const Eigen::Vector3d& linear_rgb) {
  for (int channel = 0; channel < 3; ++channel) record.color_code[channel] = code_of_share(linear_rgb[channel]);
}

}  // namespace vdbmap
