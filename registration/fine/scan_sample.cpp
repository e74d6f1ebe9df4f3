// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/scan_sample.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "registration/cell_table.h"
#include "registration/fine/shuffle.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kPointsPerPart = 8192;  // its cells stay in cache

// The first point of a cell, as far as a part of the scan knows.
struct FirstPoint {
  VoxelId cell;
  std::uint32_t index;
};

struct Sampling {
  std::span<const Eigen::Vector3d> points;
  double cells_per_metre;
  RangeLimits limits;

  bool in_range(const Eigen::Vector3d& point) const {
    const double squared_range = point.squaredNorm();  // nan is not in range
    return squared_range >= limits.min * limits.min && squared_range <= limits.max * limits.max;
  }
};

std::vector<FirstPoint> first_points(const Sampling& sampling, std::size_t begin, std::size_t end) {
  std::vector<FirstPoint> first;
  CellTable cells(512);
  VoxelId last =
      VoxelId{~std::uint64_t{0}};  // no cell; points in the order of a sweep mostly share the cell of the one before
  for (std::size_t i = begin; i < end; ++i) {
    if (!sampling.in_range(sampling.points[i])) continue;
    const VoxelId cell = id_of_voxel(voxel_of_point(sampling.points[i], sampling.cells_per_metre));
    if (cell == last) continue;
    last = cell;
    const auto index = static_cast<std::uint32_t>(i);
    if (cells.find_or_insert(cell, index) == index) first.push_back({cell, index});
  }
  return first;
}

// Parts are thinned each on its own, then, in their order, together: the same as point after point.
std::vector<std::vector<FirstPoint>> thin_parts(const Sampling& sampling) {
  const std::size_t num_parts = (sampling.points.size() + kPointsPerPart - 1) / kPointsPerPart;
  std::vector<std::vector<FirstPoint>> parts(num_parts);
  parallel_for(num_parts, [&](std::size_t part) {
    const std::size_t begin = part * kPointsPerPart;
    parts[part] = first_points(sampling, begin, std::min(begin + kPointsPerPart, sampling.points.size()));
  });
  return parts;
}

}  // namespace

std::vector<std::uint32_t> sample_indices(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                          const RangeLimits& limits) {
  if (points_in_scan.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("a scan of " + std::to_string(points_in_scan.size()) +
                                " points, expected less than 2^32");
  }
  CellTable cells(4096);
  std::vector<std::uint32_t> sample;
  for (const std::vector<FirstPoint>& part : thin_parts({points_in_scan, 1 / spacing, limits})) {
    for (const FirstPoint& first : part) {
      if (cells.find_or_insert(first.cell, first.index) == first.index) sample.push_back(first.index);
    }
  }
  return sample;
}

std::vector<Eigen::Vector3d> sample_points(std::span<const Eigen::Vector3d> points_in_scan, double spacing,
                                           const RangeLimits& limits) {
  std::vector<Eigen::Vector3d> sample;
  for (const std::uint32_t index : sample_indices(points_in_scan, spacing, limits)) {
    sample.push_back(points_in_scan[index]);
  }
  return sample;
}

SampledScan sample_scan(std::span<const Eigen::Vector3d> points_in_scan, double fine_spacing, double coarse_spacing,
                        const RangeLimits& limits) {
  constexpr double kNearRange = 20;  // [m]
  SampledScan sample;
  sample.fine = sample_points(shuffled(points_in_scan), fine_spacing, limits);
  sample.coarse = sample_points(sample.fine, coarse_spacing, limits);
  sample.near = sample_points(sample.coarse, coarse_spacing, {limits.min, kNearRange});
  return sample;
}

}  // namespace vdbmap::registration
