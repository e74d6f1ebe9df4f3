// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/ray_evidence.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "vdbmap/change/incidence_finder.h"
#include "vdbmap/core/option_check.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/ray_walk.h"

namespace vdbmap {
namespace {

constexpr double kUnknownIncidence = 0.1;  // sine of the least angle to a surface of which nothing else is known
constexpr double kMinIncidence = 0.1;      // sine; rays along a surface do not tell whether it is there
constexpr double kDiscReach = 2;           // squared Mahalanobis distance: to the edge of a disc filled evenly
constexpr double kSigmas = 3;

}  // namespace

void RayTrust::check() const {
  require(range_sigma >= 0 && range_sigma <= 1, "range_sigma", range_sigma, "0 to 1 m");
  require(position_sigma >= 0 && position_sigma <= 1, "position_sigma", position_sigma, "0 to 1 m");
  require(angle_sigma >= 0 && angle_sigma <= 0.1, "angle_sigma", angle_sigma, "0 to 0.1 rad");
  require(clearance >= 0 && clearance <= 2, "clearance", clearance, "0 to 2 m");
  require(max_range > 0, "max_range", max_range, "above 0 m");
}

/// Follows rays, one after the other. One per task.
class RayEvidence::Walker {
 public:
  explicit Walker(RayEvidence& evidence)
      : evidence_(evidence), trust_(evidence.trust_), voxel_size_(evidence.voxel_size_), blocks_(evidence.space_) {
    for (const Side& side : evidence.sides_) incidences_.emplace_back(*side.map);
  }

  void follow(const MeasuredRay& ray) {
    const double per_metre = 1 / voxel_size_;
    if (!is_addressable(ray.origin, per_metre) || !is_addressable(ray.end, per_metre)) return;
    const Eigen::Vector3d way = ray.end - ray.origin;
    length_ = way.norm();
    direction_ = way / length_;
    origin_ = ray.origin;
    time_ = TimeBins::at(ray.time);
    const double stop = std::min(length_ - margin_before(ray.end), trust_.max_range);
    if (stop > 0) walk(stop);  // false for a ray without length
  }

 private:
  // How far before its end the ray comes too near to the surface on which it ends.
  double margin_before(const Eigen::Vector3d& end) const {
    std::optional<double> least;
    for (const IncidenceFinder& finder : incidences_) {
      const std::optional<double> sine = finder.sine_of_incidence(end, direction_);
      if (sine) least = std::min(least.value_or(1), *sine);
    }
    const double sine = least.value_or(std::max(kUnknownIncidence, std::abs(direction_.z())));
    return std::max(kSigmas * trust_.range_sigma, trust_.clearance / std::max(sine, 1e-3));
  }

  void walk(double stop) {
    const RayPath path({origin_, direction_}, voxel_size_);
    constexpr std::int32_t kSize = 1 << SeenBlock::kLog2Voxels;
    VoxelIndex corner = voxel_of_point(origin_, 1 / voxel_size_);
    for (int axis = 0; axis < 3; ++axis) corner[axis] &= ~(kSize - 1);
    RayArrival arrival{0};
    while (arrival.distance < stop) {
      walk_block(blocks_.find(corner), path, arrival, stop);
      arrival.distance = std::numeric_limits<double>::infinity();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double next = path.crossing(axis, corner[static_cast<int>(axis)] + path.ahead[axis] * kSize);
        if (next < arrival.distance) arrival = {next, static_cast<int>(axis)};
      }
      if (arrival.axis < 0) return;
      corner[arrival.axis] += path.ahead[static_cast<std::size_t>(arrival.axis)] > 0 ? kSize : -kSize;
    }
  }

  void walk_block(SeenBlock& block, const RayPath& path, RayArrival arrival, double stop) {
    CellWalk<SeenBlock::kLog2Dim, VoxelLeaf::LOG2DIM> cells(path, block.origin(), arrival.distance);
    do {
      SeenLeaf& leaf = block.leaf(cells.offset());
      const bool is_full = leaf.is_full.load(std::memory_order_relaxed);
      if (is_full && !leaf.has_occupied()) continue;
      const VoxelIndex origin = block.origin_of_leaf(cells.offset());
      if (!is_full) mark_seen(leaf, origin, path, arrival, stop);
      if (leaf.has_occupied()) meet_occupied(leaf, origin, path, {arrival.distance, std::min(stop, cells.exit())});
    } while (cells.advance(arrival, stop));
  }

  static void mark_seen(SeenLeaf& leaf, const VoxelIndex& origin, const RayPath& path, RayArrival arrival,
                        double stop) {
    CellWalk<VoxelLeaf::LOG2DIM, 0> cells(path, origin, arrival.distance);
    do {
      leaf.mark(cells.offset());
    } while (cells.advance(arrival, stop));
    if (leaf.has_all_marked()) leaf.is_full.store(true, std::memory_order_relaxed);
  }

  // Apart from marking, so that what is met does not depend on what other threads have marked before. Of a leaf of
  // road, most rays pass over what is occupied.
  void meet_occupied(const SeenLeaf& leaf, const VoxelIndex& origin, const RayPath& path, const RayRange& in_leaf) {
    const std::optional<RayRange> range = clip(path, leaf.occupied_box, in_leaf);
    if (!range) return;
    RayArrival arrival{range->begin};
    CellWalk<VoxelLeaf::LOG2DIM, 0> cells(path, origin, arrival.distance);
    do {
      if (leaf.is_occupied(cells.offset())) meet_voxel(leaf, cells.offset(), arrival.distance, cells.exit());
    } while (cells.advance(arrival, range->end));
  }

  void meet_voxel(const SeenLeaf& leaf, openvdb::Index offset, double enter, double exit) {
    for (std::size_t side = 0; side < SeenLeaf::kMostLevels; ++side) {
      const VoxelLeaf* level = leaf.levels[side];
      if (!level || !level->getValueMask().isOn(offset)) continue;
      const std::size_t record = level->transientData() + rank_in_leaf(*level, offset);
      Side& met = evidence_.sides_[side];
      if (!goes_through(met.surfaces[record], level->offsetToGlobalCoord(offset), enter, exit)) continue;
      std::atomic_ref(met.passes[record]).fetch_add(1, std::memory_order_relaxed);
      add_shared(met.pass_times[record], time_);
    }
  }

  // Whether the ray goes through the disc between `enter` and `exit`, and ends behind it.
  bool goes_through(const HeldSurface& surface, const VoxelIndex& voxel, double enter, double exit) const {
    const Eigen::Vector3d mean = corner_of_voxel(voxel, voxel_size_) + surface.mean.cast<double>();
    const Eigen::Vector3d from_origin = mean - origin_;
    const double sine = surface.has_normal() ? surface.normal.cast<double>().dot(direction_) : 1;
    if (std::abs(sine) < kMinIncidence) return false;
    const double crossing =
        surface.has_normal() ? surface.normal.cast<double>().dot(from_origin) / sine : direction_.dot(from_origin);
    if (!(crossing >= enter && crossing < exit)) return false;
    const double turned = trust_.angle_sigma * crossing;
    const double position = std::sqrt(trust_.position_sigma * trust_.position_sigma + turned * turned);
    const Eigen::Vector3f off = (crossing * direction_ - from_origin).cast<float>();
    if (surface.distance_squared(off, static_cast<float>(position)) > kDiscReach) return false;
    const double spread = surface.has_normal() ? surface.variance : voxel_size_ * voxel_size_ / 12;
    const double across = trust_.range_sigma * sine;
    const double sigma = std::sqrt(spread + across * across + position * position);
    return (length_ - crossing) * std::abs(sine) >= kSigmas * sigma;
  }

  RayEvidence& evidence_;
  const RayTrust& trust_;
  double voxel_size_;
  SeenBlockFinder blocks_;
  std::vector<IncidenceFinder> incidences_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();     // of the ray that is followed
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();  // unit
  double length_ = 0;                                    // [m]
  TimeBins time_;
};

RayEvidence::RayEvidence(std::vector<const VoxelMap*> maps, const RayTrust& trust) : trust_(trust) {
  trust.check();
  if (maps.empty() || maps.size() > SeenLeaf::kMostLevels) {
    throw std::invalid_argument("rays are followed through one or two maps, not " + std::to_string(maps.size()));
  }
  voxel_size_ = maps.front()->finest().voxel_size();
  for (const VoxelMap* map : maps) {
    if (!(map->frame.anchor == maps.front()->frame.anchor)) throw std::invalid_argument("the maps have two anchors");
    if (map->finest().voxel_size() != voxel_size_) throw std::invalid_argument("the maps have two voxel sizes");
    space_.add_occupied(map->finest().tree(), sides_.size());
    sides_.push_back({map, held_surfaces(map->finest()), std::vector<std::uint32_t>(map->finest().size()),
                      std::vector<TimeBins>(map->finest().size())});
  }
}

void RayEvidence::add(std::span<const MeasuredRay> rays) {
  parallel_ranges(rays.size(), 512, [&](std::size_t begin, std::size_t end) {
    Walker walker(*this);
    for (const MeasuredRay& ray : rays.subspan(begin, end - begin)) walker.follow(ray);
  });
}

}  // namespace vdbmap
