// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "parking/objects/vehicles.h"
#include "parking/occupancy/space_columns.h"
#include "parking/spaces/parking_space.h"
#include "vdbmap/core/measured_ray.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap::parking {

/// What an epoch says of a space.
struct SpaceEvidence {
  bool is_in_map = false;             ///< whether its ground is known: nothing is said of others
  std::size_t num_columns = 0;        ///< of its room, see SpaceColumns
  std::size_t num_passed = 0;         ///< of these, rays passed through
  std::size_t num_passed_low = 0;     ///< of these, below the windows of cars: 0.3 to 0.9 m above the ground
  std::size_t num_with_vehicle = 0;   ///< of these, with points of a vehicle, up to 2.5 m above the ground
  std::size_t num_with_other = 0;     ///< of these, with points of other things
  std::size_t num_with_thing = 0;     ///< of the inner ones, with points of things, see thing_points
  std::uint64_t vehicle_points = 0;   ///< inside, 0.2 to 2.5 m above the ground
  std::uint64_t neighbor_points = 0;  ///< of these, of vehicles that stand in another space
  /// In its inner columns, 0.3 to 1.5 m above the ground, of things that are neither building, plant, vehicle, pole nor
  /// person, and that are not part of a vehicle that stands in another space.
  std::uint64_t thing_points = 0;
  double thing_height = 0;             ///< of the highest of their voxels, its mean [m above the ground]
  std::uint64_t rays_through = 0;      ///< that passed through a column or more
  std::optional<std::size_t> vehicle;  ///< that stands in it: number of the box
  double vehicle_share = 0;            ///< of the smaller one's area, that the box and the space have in common
};

/// The rooms over spaces, where the map knows the ground around them, up to 10 m away.
std::vector<std::optional<SpaceColumns>> rooms_over(std::span<const ParkingSpace> spaces, const GroundPlan& ground);

/// Rays through the rooms over spaces. Sums do not depend on the number of threads.
class PassedColumns {
 public:
  /// Rays stop so far [m] before the point that they measured.
  static constexpr double kClearance = 0.15;

  /// Keeps a reference.
  explicit PassedColumns(std::span<const std::optional<SpaceColumns>> rooms);

  /// Counts rays [m, local frame].
  void add(std::span<const MeasuredRay> rays);

  /// Counts what a map's own rays said: a column of which at least five voxels were seen to be empty was passed.
  void add(const SightFinder& sight, double voxel_size);

  /// Number of columns of a space that were passed, and of rays that passed one; of a map the rays are not known: 0.
  std::size_t num_passed(std::size_t space) const;
  std::size_t num_passed_low(std::size_t space) const;
  std::uint64_t num_rays(std::size_t space) const { return counts_[space].num_rays; }

 private:
  struct Counts {
    std::vector<std::uint8_t> is_passed, is_passed_low;  // by column
    std::uint64_t num_rays = 0;
  };

  std::span<const std::optional<SpaceColumns>> rooms_;
  std::vector<Counts> counts_;
};

/// What stands in the rooms by a level with SemanticKITTI's labels, and which of its vehicles in which space: a vehicle
/// stands in the space with which it shares most, and in others of which it shares a third. Voxels count as a vehicle's
/// too where `before`, the labelled level of the map that the spaces are of, has one of a vehicle there or next to it:
/// it is still there. Rays come from `passed`. Throws std::invalid_argument where a level has no labels or the voxel
/// sizes differ.
std::vector<SpaceEvidence> evidence_of(std::span<const ParkingSpace> spaces,
                                       std::span<const std::optional<SpaceColumns>> rooms, const VoxelLevel& level,
                                       const VoxelLevel& before, std::span<const Vehicle> vehicles,
                                       const PassedColumns& passed);

}  // namespace vdbmap::parking
