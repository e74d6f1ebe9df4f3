// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "vdbmap/core/moments.h"
#include "vdbmap/core/voxel.h"

namespace vdbmap {

/// Steps of the mean along the edge of a voxel.
inline constexpr int kMeanSteps = 16384;

/// What a map stores of one voxel, in the codes of the file's attributes; 44 bytes.
struct VoxelRecord {
  std::array<float, 6> covariance{};          ///< xx yy zz xy xz yz of the sample covariance, divisor n-1 [m^2]
  std::uint32_t count = 0;                    ///< number of points n
  std::array<std::uint16_t, 3> mean_code{};   ///< mean within the voxel in steps of 1/16384 of its edge (6 um at 10 cm)
  std::array<std::uint16_t, 3> color_code{};  ///< mean colour, linear RGB 0..1 as short floats (short_float.h)
  std::uint16_t normal_code = 0;              ///< OpenVDB's unit-vector code (math/QuantizedUnitVec.h)
  std::uint8_t planarity_code = 0;            ///< planarity of the 3x3x3 neighbourhood: 255 is 1
  std::uint8_t unused = 0;

  bool operator==(const VoxelRecord&) const = default;
};
static_assert(sizeof(VoxelRecord) == 44);

/// Sample covariance [m^2].
Eigen::Matrix3d covariance_of(const VoxelRecord& record);

/// Mean point [m, local frame] of the voxel at `voxel`.
inline Eigen::Vector3d mean_of(const VoxelRecord& record, const VoxelIndex& voxel, double voxel_size) {
  const auto& code = record.mean_code;  // a step stands for its middle
  const Eigen::Vector3d steps(code[0] + 0.5, code[1] + 0.5, code[2] + 0.5);
  return corner_of_voxel(voxel, voxel_size) + steps * (voxel_size / kMeanSteps);
}

/// Count, mean [m, local frame] and scatter [m^2].
Moments moments_of(const VoxelRecord& record, const VoxelIndex& voxel, double voxel_size);

/// Surface normal from the moments of the 3x3x3 neighbourhood: unit, z >= 0.
Eigen::Vector3d normal_of(const VoxelRecord& record);

/// (l2 - l3) / l1 of the 3x3x3 neighbourhood, 0 to 1: how far the normal can be relied on.
inline double planarity_of(const VoxelRecord& record) { return record.planarity_code / 255.0; }

/// Mean colour, linear RGB 0..1.
Eigen::Vector3d color_of(const VoxelRecord& record);

/// Stores count, mean and covariance; the mean is clamped to the voxel, the covariance rounded by round_covariance().
void set_moments(VoxelRecord& record, const Moments& moments, const VoxelIndex& voxel, double voxel_size);

/// An element [m^2] of the covariance of `count` points, rounded to 8 bits (0.4 % of its value at most) up to 256
/// points and to 16 bits (1.5e-5) beyond: far below what the points determine, sqrt(2 / n) of a variance, which are 9 %
/// for 256. The bytes it frees compress away in the file.
float round_covariance(double value, std::int64_t count);

/// Stores a unit normal, to 0.65 degrees; one of zeros, or that is not finite, as (0, 0, 1).
void set_normal(VoxelRecord& record, const Eigen::Vector3d& normal);

/// Stores a linear colour, clamped to 0..1 (NaN to 0) and rounded to 8 bits: 8-bit sRGB colours stay what they are.
void set_color(VoxelRecord& record, const Eigen::Vector3d& linear_rgb);

}  // namespace vdbmap
