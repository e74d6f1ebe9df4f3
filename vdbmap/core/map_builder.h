// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"
#include "vdbmap/core/unreachable_points.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// How a map is built.
struct BuildOptions {
  std::vector<double> voxel_sizes = {0.1, 1.0};  ///< [m] finest first, each a whole multiple of the one before
  std::optional<Eigen::Vector3d> anchor;         ///< default: anchor_for() the first cloud
  std::optional<int> epsg;                       ///< of the points' coordinates
  std::optional<std::int32_t> epoch;             ///< stored as first and last epoch of every voxel

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// Collects points and makes a map of them. Memory grows with the voxels, not with the points. The map is the same, bit
/// for bit, for any order of the points, any cut into calls and any number of threads, as long as the anchor is the
/// same: one that is not given depends on the first cloud, and there mostly on the first point.
class MapBuilder {
 public:
  /// Throws std::invalid_argument for bad options.
  explicit MapBuilder(BuildOptions options);
  ~MapBuilder();
  MapBuilder(MapBuilder&&) noexcept;
  MapBuilder& operator=(MapBuilder&&) noexcept;

  /// Adds the points of a cloud moved by `map_from_cloud` (original system). A point whose voxel index does not fit 21
  /// bits is left out. Throws std::out_of_range, naming the first one, where that is half of the cloud or more; the
  /// builder is then unusable.
  void add(const PointCloud& cloud, const Eigen::Isometry3d& map_from_cloud = Eigen::Isometry3d::Identity());

  /// What was left out of the cloud that was given last, to add() or to finish().
  const UnreachablePoints& unreachable() const;

  /// Number of points added.
  std::size_t num_points() const;

  /// The map of all points added, normals included; the builder is as new afterwards.
  VoxelMap finish();

  /// As add() and then finish(), but faster, and with less memory, where the last cloud is a large part of the map.
  VoxelMap finish(const PointCloud& last_cloud,
                  const Eigen::Isometry3d& map_from_cloud = Eigen::Isometry3d::Identity());

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The map of one cloud in the original system.
VoxelMap build_map(const PointCloud& cloud, const BuildOptions& options = {});

}  // namespace vdbmap
