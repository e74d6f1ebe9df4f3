// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/fine/plane_match.h"

#include <cmath>
#include <limits>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

// Voxels belong to one surface where their means are as near along the normal, and their normals as alike.
constexpr double kMaxShareOfVoxel = 0.5;  // two layers of one noisy surface are a third of a voxel apart
constexpr double kMinCosine = 0.97;       // 14 degrees

// The occupied voxels around a point, and which of them is nearest to it.
class Surroundings {
 public:
  explicit Surroundings(const VoxelLevel& level)
      : finder_(level), voxel_size_(level.voxel_size()), per_metre_(voxels_per_metre(level.voxel_size())) {}

  void look(const Eigen::Vector3d& point, int reach) {
    voxels_.clear();
    if (!is_addressable(point, per_metre_)) return;
    double nearest_distance = std::numeric_limits<double>::infinity();
    finder_.for_each_around(voxel_of_point(point, per_metre_), reach,
                            [&](const VoxelIndex& voxel, const VoxelRecord& record) {
                              voxels_.push_back({&record, mean_of(record, voxel, voxel_size_)});
                              const double distance = (voxels_.back().mean - point).squaredNorm();
                              if (distance >= nearest_distance) return;
                              nearest_distance = distance;
                              nearest_ = voxels_.size() - 1;
                            });
  }

  bool empty() const { return voxels_.empty(); }
  const VoxelRecord& nearest() const { return *voxels_[nearest_].record; }
  const Eigen::Vector3d& nearest_mean() const { return voxels_[nearest_].mean; }

  // A point of the plane with that normal: the mean of all points around that belong to the same surface, along the
  // normal. A noisy surface on the border between two layers of voxels has means on either side; the nearest alone
  // would draw the whole scan to one of them.
  Eigen::Vector3d point_of_plane(const Eigen::Vector3d& normal) const {
    double sum = 0;
    double count = 0;
    for (const Voxel& voxel : voxels_) {
      const double distance = normal.dot(voxel.mean - nearest_mean());
      const bool is_near = std::abs(distance) <= kMaxShareOfVoxel * voxel_size_;
      if (!is_near || std::abs(normal_of(*voxel.record).dot(normal)) < kMinCosine) continue;
      sum += voxel.record->count * distance;
      count += voxel.record->count;
    }
    return count > 0 ? Eigen::Vector3d(nearest_mean() + sum / count * normal) : nearest_mean();
  }

 private:
  struct Voxel {
    const VoxelRecord* record;
    Eigen::Vector3d mean;
  };

  VoxelFinder finder_;
  double voxel_size_;
  double per_metre_;
  std::vector<Voxel> voxels_;
  std::size_t nearest_ = 0;
};

PlaneMatch match_plane(const Surroundings& around, const Eigen::Vector3d& point_in_scan, const MatchOptions& options) {
  PlaneMatch match{point_in_scan, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0};
  if (around.empty()) return match;
  const VoxelRecord& record = around.nearest();
  match.mean = around.nearest_mean();
  if (options.plane_from_voxel) {
    if (record.count < 5) return match;
    const PlaneFit plane = fit_plane(covariance_of(record));
    match.normal = plane.normal;
    match.planarity = plane.planarity;
  } else {
    match.normal = normal_of(record);
    match.planarity = planarity_of(record);
    match.mean = around.point_of_plane(match.normal);
  }
  return match;
}

}  // namespace

std::vector<PlaneMatch> match_planes(std::span<const Eigen::Vector3d> points_in_scan, const VoxelLevel& level,
                                     const Eigen::Isometry3d& local_from_scan, const MatchOptions& options) {
  constexpr std::size_t kGrain = 256;
  std::vector<PlaneMatch> matches(points_in_scan.size());
  parallel_ranges(points_in_scan.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Surroundings around(level);
    for (std::size_t i = begin; i < end; ++i) {
      around.look(local_from_scan * points_in_scan[i], options.search_voxels);
      matches[i] = match_plane(around, points_in_scan[i], options);
    }
  });
  std::erase_if(matches, [&](const PlaneMatch& match) {
    return match.planarity < options.min_planarity || match.planarity <= 0;
  });
  return matches;
}

}  // namespace vdbmap::registration
