// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "registration/cell_table.h"

namespace vdbmap::registration {

/// How much of the surroundings a LocalMap keeps; the values of KISS-ICP (Vizzo 2023, table I).
struct LocalMapOptions {
  double voxel_size = 1.0;    ///< [m]
  int points_per_voxel = 20;  ///< at most, 1 to LocalMap::kCapacity
  double max_distance = 100;  ///< [m] voxels farther from the sensor are forgotten

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// The points around a moving sensor, a few in every voxel, for nearest-neighbour search. Its memory is bounded: by the
/// voxels within the distance, times the points a voxel.
class LocalMap {
 public:
  static constexpr int kCapacity = 24;  // three vectors of eight floats

  /// Throws std::invalid_argument for bad options.
  explicit LocalMap(const LocalMapOptions& options);

  /// Adds points [m, frame of the map], in their order, to voxels that are not full and hold none nearer than
  /// voxel_size / sqrt(points_per_voxel): a sensor that stands still fills no voxel with copies of a point (so KISS-ICP
  /// since 1.0). Points whose voxel index has more than 21 bits are left out.
  void insert(std::span<const Eigen::Vector3d> points);

  /// Forgets voxels whose centre is farther than the greatest distance from the sensor [m, frame of the map].
  void forget_far(const Eigen::Vector3d& sensor);

  /// The nearest point within `max_distance` [m] in the voxel of `point` and its 26 neighbours; among equally near
  /// ones the same every time.
  std::optional<Eigen::Vector3d> nearest(const Eigen::Vector3d& point, double max_distance) const;

  bool empty() const { return cells_.empty(); }
  std::size_t num_voxels() const { return cells_.size(); }
  std::size_t num_points() const;

  /// All points [m, frame of the map].
  std::vector<Eigen::Vector3d> points() const;

 private:
  // Points relative to the voxel's corner, so that floats keep them to 0.1 micrometres anywhere; unused places are too
  // far away to be nearest.
  struct Block {
    std::array<float, kCapacity> x;
    std::array<float, kCapacity> y;
    std::array<float, kCapacity> z;
    std::int32_t count = 0;

    Block();
  };
  struct Nearest;

  void add(const Eigen::Vector3f& point_in_block, Block& block) const;
  static void search(const Block& block, const Eigen::Vector3f& point_in_block, std::uint32_t number, Nearest& nearest);
  Eigen::Vector3d point_of(std::uint32_t block, int place) const;

  LocalMapOptions options_;
  double voxels_per_metre_;
  float squared_spacing_;       // [m^2]
  CellTable table_;             // the block of each cell
  std::vector<VoxelId> cells_;  // one a block
  std::vector<Block> blocks_;
};

}  // namespace vdbmap::registration
