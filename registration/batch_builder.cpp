// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/batch_builder.h"

#include <algorithm>

#include "vdbmap/core/map_builder.h"

namespace vdbmap::registration {
namespace {

constexpr std::size_t kPointsPerScan = 30'000;  // enough for voxels of 1 m, a quarter of a dense scan
constexpr std::size_t kRays = 1000;

constexpr double kFineSpacing = 1.5;    // [m] many scans together need fewer points each
constexpr double kCoarseSpacing = 3.0;  // [m]

// Scans are limited by their own ranges already.
constexpr RangeLimits kEverywhere{0, 1e6};

}  // namespace

void BatchBuilder::add(std::span<const Eigen::Vector3d> points_in_scan, const SampledScan& sample,
                       const Eigen::Isometry3d& batch_from_scan) {
  const std::size_t step = std::max<std::size_t>(1, points_in_scan.size() / kPointsPerScan);
  for (std::size_t i = 0; i < points_in_scan.size(); i += step) {
    const double range = points_in_scan[i].norm();
    if (range < range_.min || range > range_.max) continue;
    points_.positions.push_back(batch_from_scan * points_in_scan[i]);
  }
  for (const Eigen::Vector3d& point : sample.fine) sample_.push_back(batch_from_scan * point);
  sensors_.push_back(batch_from_scan);
  ends_.push_back(sample_.size());
}

CombinedScans BatchBuilder::combine() const {
  BuildOptions options;
  options.voxel_sizes = {voxel_size_};
  options.anchor = Eigen::Vector3d::Zero();
  VoxelMap map = build_map(points_, options);  // of one level

  std::vector<MeasuredRay> rays;
  const std::size_t step = std::max<std::size_t>(1, sample_.size() / kRays);
  std::size_t scan = 0;
  for (std::size_t i = 0; i < sample_.size(); i += step) {
    while (i >= ends_[scan]) ++scan;
    rays.push_back({sensors_[scan].translation(), sample_[i]});
  }
  std::vector<SurfacePiece> pieces = flat_pieces(map.levels.front());
  return {std::move(map.levels.front()), sample_scan(sample_, kFineSpacing, kCoarseSpacing, kEverywhere),
          std::move(pieces), std::move(rays)};
}

}  // namespace vdbmap::registration
