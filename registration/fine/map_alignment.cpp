// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/map_alignment.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "registration/fine/point_to_plane.h"

namespace vdbmap::registration {
namespace {

constexpr double kSpacing = 0.5;           // [m] of the voxels used on the finest level
constexpr double kCoarseSpacing = 1.5;     // [m] on the coarser ones
constexpr double kLeastInlierShare = 0.3;  // else the maps are hardly of one place
constexpr std::size_t kFewestPoints = 30;

std::vector<Eigen::Vector3d> means_about(const VoxelMap& map, const Eigen::Vector3d& middle) {
  std::vector<Eigen::Vector3d> means;
  const VoxelLevel& level = map.finest();
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t record) {
    means.emplace_back(mean_of(level.records()[record], voxel, level.voxel_size()) + map.frame.anchor - middle);
  });
  return means;
}

}  // namespace

MapAlignment align_maps(const VoxelMap& earlier, const VoxelMap& later) {
  const auto box = extent(later);
  if (!box || !extent(earlier)) throw std::invalid_argument("a map without voxels cannot be aligned");
  const Eigen::Vector3d middle = (box->min + box->max) / 2;
  const RangeLimits everything{0, std::numeric_limits<double>::max()};
  const SampledScan sample = sample_scan(means_about(later, middle), kSpacing, kCoarseSpacing, everything);
  FineOptions options;
  options.search_headings = false;
  const FineResult fine = align_sample(sample, earlier, Eigen::Isometry3d(Eigen::Translation3d(middle)), options);
  if (fine.num_points < kFewestPoints || fine.inlier_share < kLeastInlierShare) {
    throw std::invalid_argument("the maps cannot be aligned: of " + std::to_string(fine.num_points) +
                                " places of the later one " + std::to_string(std::lround(100 * fine.inlier_share)) +
                                " % lie on surfaces of the earlier one");
  }
  MapAlignment alignment;
  alignment.earlier_from_later = fine.map_from_scan * Eigen::Translation3d(-middle);
  alignment.shift = fine.map_from_scan.translation() - middle;
  alignment.turn_deg = Eigen::AngleAxisd(fine.map_from_scan.linear()).angle() * 180 / std::numbers::pi;
  alignment.inlier_share = fine.inlier_share;
  alignment.num_points = fine.num_points;
  return alignment;
}

}  // namespace vdbmap::registration
