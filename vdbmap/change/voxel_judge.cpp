// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/voxel_judge.h"

#include <cmath>
#include <limits>

namespace vdbmap {
namespace {

constexpr std::int32_t kPorousReach = 1;  // [voxels] around a porous thing, in which rays may or may not meet it
constexpr int kFewestPorous = 2;          // voxels that make one
constexpr double kSurface = 0.35;         // planarity from which a stored normal is one of a surface
constexpr double kPorousPlanarity = 0.2;  // of the 3 x 3 x 3 voxels around a voxel of a porous thing, at most
constexpr double kMostlyKnown = 0.7;      // share of the voxels around one that belongs to no surface
constexpr double kLeastHitShare = 0.1;    // of the rays that met what a voxel holds
constexpr std::uint64_t kFewestRays = 5;  // that say something of a voxel

Eigen::Vector3d mean_in_voxel(const VoxelRecord& record, double voxel_size) {
  return mean_of(record, VoxelIndex(0, 0, 0), voxel_size);
}

// The next voxel in a direction, one of 26.
VoxelIndex step_along(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d scaled = direction / direction.cwiseAbs().maxCoeff();
  return {static_cast<std::int32_t>(std::lround(scaled.x())), static_cast<std::int32_t>(std::lround(scaled.y())),
          static_cast<std::int32_t>(std::lround(scaled.z()))};
}

}  // namespace

VoxelJudge::VoxelJudge(const SeenMap& subject, const SeenMap& other, const Placement& placement,
                       const SignificanceLimits& limits, bool takes_unseen_as_empty)
    : subject_(subject.map.finest()),
      subject_visibility_(subject.visibility),
      subject_finder_(subject_),
      other_finder_(other.map.finest()),
      other_seen_empty_(other.visibility ? &other.visibility->seen_empty : nullptr),
      placement_(placement),
      limits_(limits),
      takes_unseen_as_empty_(takes_unseen_as_empty),
      voxel_size_(subject_.voxel_size()) {}

Judgement VoxelJudge::judge(const VoxelIndex& voxel, std::size_t record) const {
  const VoxelRecord& stored = subject_.records()[record];
  const VoxelIndex other = placement_.other_voxel(voxel, stored);
  const VoxelRecord* counterpart = other_finder_.find(other);
  const Eigen::Vector3d mean = placement_.seen_from(other, voxel, mean_in_voxel(stored, voxel_size_));
  if (counterpart && is_evidently_same(stored, *counterpart, mean - mean_in_voxel(*counterpart, voxel_size_))) {
    return {};
  }
  const LocalSurface around = around_in_subject(voxel, other);
  const PointSums sums_in_other = sums_around_in_other(other);
  if (sums_in_other.count() < 1) return judge_unexplained(other, record, around, nullptr);

  LocalSurface of_voxel;
  of_voxel.count = stored.count;
  of_voxel.mean = mean;
  of_voxel.covariance = placement_.rotation() * covariance_of(stored) * placement_.rotation().transpose();
  const LocalSurface surface = surface_of(sums_in_other);
  const Distance distance = counterpart || surface.is_planar()
                                ? distance_between(of_voxel, around, surface, voxel_size_, limits_)
                                : distance_from_nearest(other, of_voxel);
  if (!distance.is_significant()) return {};
  if (counterpart) {
    if (is_transient(record)) return {};
    return {Change::kChanged, confidence_of(distance)};
  }
  return judge_unexplained(other, record, around, &distance);
}

// A sufficient condition of the test of surfaces, for what is seen of two voxels alone: most voxels end here.
bool VoxelJudge::is_evidently_same(const VoxelRecord& a, const VoxelRecord& b, const Eigen::Vector3d& apart) const {
  const double limit = limits_.sigmas * limits_.sigmas * limits_.common_variance;
  if (apart.squaredNorm() <= limit) return true;
  if (planarity_of(b) < kSurface || planarity_of(a) < kSurface) return false;
  const double distance = normal_of(b).dot(apart);
  return distance * distance <= limit;
}

LocalSurface VoxelJudge::around_in_subject(const VoxelIndex& voxel, const VoxelIndex& other) const {
  PointSums sums;
  subject_finder_.for_each_around(voxel, 1, [&](const VoxelIndex& near, const VoxelRecord& record) {
    sums.add(sums_of(record, mean_of(record, near - voxel, voxel_size_)));
  });
  LocalSurface surface = surface_of(sums);
  if (placement_.is_whole()) return surface;
  const Eigen::Matrix3d& rotation = placement_.rotation();
  surface.mean = placement_.seen_from(other, voxel, surface.mean);
  surface.covariance = rotation * surface.covariance * rotation.transpose();
  surface.normal = rotation * surface.normal;
  return surface;
}

PointSums VoxelJudge::sums_around_in_other(const VoxelIndex& other) const {
  PointSums sums;
  other_finder_.for_each_around(other, 1, [&](const VoxelIndex& near, const VoxelRecord& record) {
    sums.add(sums_of(record, mean_of(record, near - other, voxel_size_)));
  });
  return sums;
}

Distance VoxelJudge::distance_from_nearest(const VoxelIndex& other, const LocalSurface& voxel) const {
  Distance least{std::numeric_limits<double>::infinity(), limits_.sigmas, false};
  other_finder_.for_each_around(other, 1, [&](const VoxelIndex& near, const VoxelRecord& record) {
    const VoxelPoints beside{mean_of(record, near - other, voxel_size_), static_cast<double>(record.count)};
    const Distance distance = distance_of_edges({voxel.mean, voxel.count}, beside, voxel_size_, limits_);
    if (distance.sigmas < least.sigmas) least = distance;
  });
  return least;
}

// Whether its own map's rays went through it nearly always: something that moved, or drops of rain.
bool VoxelJudge::is_transient(std::size_t record) const {
  if (!subject_visibility_) return false;
  const std::uint64_t hits = subject_visibility_->hits[record], passes = subject_visibility_->passes[record];
  return hits + passes >= kFewestRays &&
         static_cast<double>(hits) < kLeastHitShare * static_cast<double>(hits + passes);
}

bool VoxelJudge::has_porous_around(const VoxelIndex& other) const {
  int count = 0;
  other_finder_.for_each_around(other, kPorousReach, [&](const VoxelIndex&, const VoxelRecord& record) {
    count += planarity_of(record) < kPorousPlanarity ? 1 : 0;
  });
  return count >= kFewestPorous;
}

bool VoxelJudge::is_known(const VoxelIndex& other) const {
  if (takes_unseen_as_empty_) return true;
  const openvdb::Index offset = VoxelLeaf::coordToOffset(other);
  if (other_seen_empty_) {
    const VoxelLeaf* leaf = other_seen_empty_->find_leaf(other);
    if (leaf && leaf->getValueMask().isOn(offset)) return true;
  }
  return other_finder_.find(other) != nullptr;
}

double VoxelJudge::known_share(const VoxelIndex& other) const {
  int count = 0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) count += is_known(other.offsetBy(x, y, z)) ? 1 : 0;
    }
  }
  return count / 27.0;
}

// Rays may pass through a voxel beside what it holds. What they saw on both sides of a surface they saw through it.
bool VoxelJudge::is_seen_through(const VoxelIndex& other, const LocalSurface& around, double share) const {
  if (!around.is_planar()) return share >= kMostlyKnown;
  const VoxelIndex step = step_along(around.normal);
  const auto sees = [&](const VoxelIndex& way) { return is_known(other + way) || is_known(other + way + way); };
  return sees(step) && sees(-step);
}

Judgement VoxelJudge::judge_unexplained(const VoxelIndex& other, std::size_t record, const LocalSurface& around,
                                        const Distance* distance) const {
  if (!is_known(other)) return {Change::kUnobserved, 1};
  if (is_transient(record)) return {};
  if (distance && distance->is_between_planes) return {Change::kChanged, confidence_of(*distance)};
  if (!around.is_planar() && has_porous_around(other)) return {};
  const double share = known_share(other);
  if (!is_seen_through(other, around, share)) return {Change::kUnobserved, 1};
  return {Change::kAppeared, share};
}

}  // namespace vdbmap
