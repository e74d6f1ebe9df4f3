// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_record.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <openvdb/math/QuantizedUnitVec.h>

#include "vdbmap/core/short_float.h"

namespace vdbmap {
namespace {

constexpr std::int64_t kFewPoints = 256;
constexpr std::uint32_t kDroppedBitsOfFewPoints = 16;
constexpr std::uint32_t kDroppedBits = 8;

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
  return {float_of_short(code[0]), float_of_short(code[1]), float_of_short(code[2])};
}

void set_moments(VoxelRecord& record, const Moments& moments, const VoxelIndex& voxel, double voxel_size) {
  const Eigen::Vector3d share = (moments.mean - corner_of_voxel(voxel, voxel_size)) / voxel_size;
  for (int axis = 0; axis < 3; ++axis) {
    record.mean_code[axis] = static_cast<std::uint16_t>(std::clamp(share[axis] * kMeanSteps, 0.0, kMeanSteps - 1.0));
  }

  constexpr std::int64_t kMaxCount = std::numeric_limits<std::int32_t>::max();  // the file's type
  record.count = static_cast<std::uint32_t>(std::min(moments.count, kMaxCount));

  const Eigen::Matrix3d covariance = moments.covariance();
  const auto rounded = [&](int row, int column) { return round_covariance(covariance(row, column), moments.count); };
  record.covariance = {rounded(0, 0), rounded(1, 1), rounded(2, 2), rounded(0, 1), rounded(0, 2), rounded(1, 2)};
}

float round_covariance(double value, std::int64_t count) {
  const std::uint32_t step = 1u << (count <= kFewPoints ? kDroppedBitsOfFewPoints : kDroppedBits);
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return std::bit_cast<float>((bits + step / 2) & ~(step - 1));
}

void set_normal(VoxelRecord& record, const Eigen::Vector3d& normal) {
  // The code keeps three signs and |x|, |y| as 126ths of |x|+|y|+|z|. OpenVDB's pack() rounds down, which tilts every
  // normal towards z. Here all three are rounded to the nearest, and where they do not add up to 126 the one farthest
  // from its value gives way: the nearest code, without bias.
  const double length = normal.lpNorm<1>();
  if (!(length > 0 && length < std::numeric_limits<double>::infinity())) {
    record.normal_code = 0;  // up: files of other programs have normals of zeros and NaN
    return;
  }
  const Eigen::Array3d scaled = normal.array().abs() * (126.0 / length);
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
  for (int channel = 0; channel < 3; ++channel) {
    const double value = linear_rgb[channel];  // may be NaN in a file of another program
    record.color_code[channel] = value > 0 ? short_of_float(static_cast<float>(std::min(value, 1.0))) : 0;
  }
}

}  // namespace vdbmap
