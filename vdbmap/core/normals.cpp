// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/normals.h"

#include <algorithm>
#include <cmath>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/leaf_neighborhood.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/plane_solver.h"

namespace vdbmap {
namespace {

constexpr int kLanes = 4;  // planes solved side by side

// Four neighbourhoods side by side; value i of each is row i.
using SumsOfFour = Eigen::Array<double, 10, kLanes>;

// The scatter about the mean: a multiple of the covariance.
Symmetric3<Eigen::Array4d> scatter_of(const SumsOfFour& sums) {
  const auto row = [&](int i) -> Eigen::Array4d { return sums.row(i).transpose(); };
  const Eigen::Array4d n = row(0).max(1.0);  // empty lanes at the end stay finite
  const Eigen::Array4d x = row(1), y = row(2), z = row(3);
  return {row(4) - x * x / n, row(5) - y * y / n, row(6) - z * z / n,
          row(7) - x * y / n, row(8) - x * z / n, row(9) - y * z / n};
}

void set_plane(VoxelRecord& record, double count, const Eigen::Vector3d& normal, double planarity) {
  constexpr double kMinPoints = 3;
  const bool is_plane = count >= kMinPoints;
  set_normal(record, is_plane ? upward(normal) : Eigen::Vector3d::UnitZ());
  record.planarity_code = static_cast<std::uint8_t>(is_plane ? planarity * 255 + 0.5 : 0);
}

void set_planes(std::span<VoxelRecord> records, const SumsOfFour& sums) {
  const SolvedPlane<Eigen::Array4d> planes = solve_plane(scatter_of(sums));
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto lane = static_cast<Eigen::Index>(i);
    set_plane(records[i], sums(0, lane), {planes.x[lane], planes.y[lane], planes.z[lane]}, planes.planarity[lane]);
  }
}

void set_planes_of_leaf(const VoxelLeaf& leaf, const LeafNeighborhood& neighborhood, std::span<VoxelRecord> records) {
  SumsOfFour sums = SumsOfFour::Zero();
  std::size_t first_record = leaf.transientData();
  int lane = 0;
  for (auto voxel = leaf.getValueMask().beginOn(); voxel; ++voxel) {
    sums.col(lane++) = Eigen::Map<const Eigen::Array<double, 10, 1>>(neighborhood.around(voxel.pos()).values.data());
    if (lane < kLanes) continue;
    set_planes(records.subspan(first_record, kLanes), sums);
    first_record += kLanes;
    lane = 0;
  }
  set_planes(records.subspan(first_record, static_cast<std::size_t>(lane)), sums);
}

}  // namespace

void compute_normals(VoxelLevel& level) {
  constexpr std::size_t kGrain = 32;
  const std::span<const VoxelLeaf> leaves = level.leaves();
  parallel_ranges(leaves.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    LeafNeighborhood neighborhood(level);
    for (std::size_t i = begin; i < end; ++i) {
      neighborhood.load(leaves[i]);
      set_planes_of_leaf(leaves[i], neighborhood, level.records());
    }
  });
}

}  // namespace vdbmap
