// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/scan_sample.h"

#include <bit>
#include <cstdint>

#include "vdbmap/core/voxel.h"

namespace vdbmap::registration {
namespace {

// Open addressing over packed cell indices; no cell packs to kEmpty.
class CellSet {
 public:
  explicit CellSet(std::size_t max_cells) : slots_(std::bit_ceil(2 * max_cells + 16), kEmpty) {}

  // Whether the cell was new.
  bool insert(std::uint64_t cell) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = (cell * 0x9E3779B97F4A7C15u) >> 32 & mask;
    while (slots_[slot] != kEmpty) {
      if (slots_[slot] == cell) return false;
      slot = (slot + 1) & mask;
    }
    slots_[slot] = cell;
    return true;
  }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  std::vector<std::uint64_t> slots_;
};

std::uint64_t packed(const VoxelIndex& cell) {
  const auto bits = [](std::int32_t i) { return static_cast<std::uint64_t>(i + kIndexLimit) & 0x1fffff; };
  return bits(cell.x()) << 42 | bits(cell.y()) << 21 | bits(cell.z());
}

}  // namespace

std::vector<Eigen::Vector3d> sample_points(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                           const RangeLimits& limits) {
  const double cells_per_metre = 1 / spacing;
  CellSet cells(points_in_scan.size());
  std::vector<Eigen::Vector3d> sample;
  for (const Eigen::Vector3d& point : points_in_scan) {
    const double squared_range = point.squaredNorm();
    const bool in_range = squared_range >= limits.min * limits.min && squared_range <= limits.max * limits.max;
    if (in_range && cells.insert(packed(voxel_of_point(point, cells_per_metre)))) sample.push_back(point);
  }
  return sample;
}

SampledScan sample_scan(std::span<const Eigen::Vector3d> points_in_scan, double fine_spacing, double coarse_spacing,
                        const RangeLimits& limits) {
  constexpr double kNearRange = 20;  // [m]
  SampledScan sample;
  sample.fine = sample_points(points_in_scan, fine_spacing, limits);
  sample.coarse = sample_points(sample.fine, coarse_spacing, limits);
  sample.near = sample_points(sample.coarse, coarse_spacing, {limits.min, kNearRange});
  return sample;
}

}  // namespace vdbmap::registration
