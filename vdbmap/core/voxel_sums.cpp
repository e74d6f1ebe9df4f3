// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbmap {
namespace {

__extension__ using Int128 = __int128;

constexpr std::array<std::array<int, 2>, 6> kProductAxes{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

// n sum(ab) - sum(a) sum(b) is exact in 128 bits: no cancellation, however far the points lie from the centre.
double centered(const VoxelSums& sums, int product) {
  const auto [a, b] = kProductAxes[product];
  const Int128 n_product = static_cast<Int128>(sums.count) * sums.product[product];
  const Int128 sum_product = static_cast<Int128>(sums.position[a]) * sums.position[b];
  return static_cast<double>(n_product - sum_product);
}

constexpr std::int64_t kIntensityCarry = std::int64_t{1} << 62;

// Two sums that are carried, and one and an intensity, add up without overflow.
void carry_intensity(VoxelSums& sums) {
  if (sums.intensity >= kIntensityCarry / 2) {
    sums.intensity -= kIntensityCarry;
    ++sums.intensity_carry;
  } else if (sums.intensity < -kIntensityCarry / 2) {
    sums.intensity += kIntensityCarry;
    --sums.intensity_carry;
  }
}

}  // namespace

void VoxelSums::add(const VoxelSums& other) {
  count += other.count;
  for (int i = 0; i < 3; ++i) position[i] += other.position[i];
  for (int i = 0; i < 6; ++i) product[i] += other.product[i];
  num_colored += other.num_colored;
  for (int i = 0; i < 3; ++i) color[i] += other.color[i];
  num_with_intensity += other.num_with_intensity;
  intensity += other.intensity;
  intensity_carry += other.intensity_carry;
  carry_intensity(*this);
}

VoxelRecord record_of(const VoxelSums& sums, double voxel_size) {
  const auto n = static_cast<double>(sums.count);
  VoxelRecord record;
  record.count =
      static_cast<std::uint32_t>(std::min<std::int64_t>(sums.count, std::numeric_limits<std::int32_t>::max()));

  for (int axis = 0; axis < 3; ++axis) {
    // A quantum stands for its middle, half a quantum above its lower end.
    const double share = (static_cast<double>(sums.position[axis]) / n + 0.5) / kQuantaPerVoxel + 0.5;
    record.mean_code[axis] = static_cast<std::uint16_t>(share * kMeanSteps);
  }
  if (sums.num_colored > 0) {
    const double scale = 1 / (65535.0 * static_cast<double>(sums.num_colored));
    const Eigen::Vector3d sum(static_cast<double>(sums.color[0]), static_cast<double>(sums.color[1]),
                              static_cast<double>(sums.color[2]));
    set_color(record, sum * scale);
  }
  if (sums.count > 1) {
    const double quantum = voxel_size / kQuantaPerVoxel;
    const double scale = quantum * quantum / (n * (n - 1));
    for (int i = 0; i < 6; ++i) record.covariance[i] = round_covariance(centered(sums, i) * scale, sums.count);
  }
  return record;
}

void add_intensity(VoxelSums& sums, double intensity) {
  if (!(std::abs(intensity) <= kLargestIntensity)) return;
  ++sums.num_with_intensity;
  sums.intensity += std::llround(intensity * 65536.0);
  carry_intensity(sums);
}

float intensity_of(const VoxelSums& sums) {
  if (sums.num_with_intensity == 0) return 0;
  const Int128 sum = static_cast<Int128>(sums.intensity_carry) * kIntensityCarry + sums.intensity;
  return static_cast<float>(static_cast<double>(sum) / (65536.0 * static_cast<double>(sums.num_with_intensity)));
}

}  // namespace vdbmap
