// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "vdbmap/core/moments.h"
#include "vdbmap/core/voxel_record.h"

namespace vdbmap {

/// Sums over the points of one voxel in whole numbers: addition is exact, so the result depends neither on the order
/// of the points nor on how they were cut into scans, files or threads.
///
/// Positions count from the voxel's centre in quanta of 2^-16 of its edge (1.5 um at 10 cm).
struct VoxelSums {
  std::int64_t count = 0;
  std::array<std::int64_t, 3> position{};  ///< [quanta]
  std::array<std::int64_t, 6> product{};   ///< xx yy zz xy xz yz [quanta^2]
  std::int64_t num_colored = 0;            ///< points that have a colour
  std::array<std::int64_t, 3> color{};     ///< linear, 65535 is 1
  std::uint32_t num_with_intensity = 0;    ///< points that have an intensity
  std::int32_t intensity_carry = 0;        ///< [2^46 of the source's unit] of the sum of intensities
  std::int64_t intensity = 0;              ///< [2^-16 of the source's unit] added to that

  void add(const VoxelSums& other);
};

/// Quanta along the edge of a voxel.
inline constexpr double kQuantaPerVoxel = 65536.0;

/// The record of the sums, without a normal.
VoxelRecord record_of(const VoxelSums& sums, double voxel_size);

/// Intensities beyond these, on either side of 0, do not count: the sum of more points than can be still fits.
inline constexpr double kLargestIntensity = 549'755'813'888.0;  // 2^39

/// Adds the intensity of a point; one that is not a number or too large does not count.
void add_intensity(VoxelSums& sums, double intensity);

/// Mean intensity in the source's unit; 0 where no point has one.
float intensity_of(const VoxelSums& sums);

}  // namespace vdbmap
