// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "vdbmap/change/ray_evidence.h"
#include "vdbmap/core/map_history.h"
#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

/// The last steps of an update: what becomes of the voxels of a map and of a drive, of a whole map or of a part of it
/// with what is around.
namespace vdbmap {

/// Linear grey, of voxels that only a drive without colours saw in a map with colours: in pictures, black reads as a
/// shadow.
inline const Eigen::Vector3d kUnknownColor = Eigen::Vector3d::Constant(0.25);

/// What became of voxels of the finest level.
struct UpdateCounts {
  std::size_t added = 0;             ///< new in the map
  std::size_t confirmed = 0;         ///< of the map, seen again: points were added
  std::size_t replaced = 0;          ///< of the map, where the drive saw something else
  std::size_t gone = 0;              ///< of the map, seen through
  std::size_t unseen = 0;            ///< of the map, as they were
  std::size_t moved = 0;             ///< of the drive, left out: something was there for a while only
  std::size_t num_points = 0;        ///< of the drive
  std::size_t num_moved_points = 0;  ///< in voxels left out
};

inline UpdateCounts operator+(const UpdateCounts& a, const UpdateCounts& b) {
  return {a.added + b.added,           a.confirmed + b.confirmed,
          a.replaced + b.replaced,     a.gone + b.gone,
          a.unseen + b.unseen,         a.moved + b.moved,
          a.num_points + b.num_points, a.num_moved_points + b.num_moved_points};
}

/// What a map's history tells of them.
inline MapChanges changes_of(const UpdateCounts& counts) {
  return {counts.added, counts.confirmed, counts.replaced, counts.gone, counts.unseen, counts.moved};
}

/// What becomes of the voxels of a map, and which of a drive come into it.
class VoxelFates {
 public:
  /// `gone` and `moved`: one value a record of the map and of the drive, 1 where it was seen through. Keeps references
  /// to the levels.
  VoxelFates(const VoxelLevel& map, const VoxelLevel& drive, const std::vector<std::uint8_t>& gone,
             std::vector<std::uint8_t> moved, const RayTrust& trust);

  /// Whether a voxel of the map is in it still, points of the drive added or not.
  bool stays(std::size_t record) const { return fates_[record] == Fate::kUnseen || fates_[record] == Fate::kConfirmed; }

  /// Whether a voxel of the drive comes into the map.
  bool is_still(std::size_t drive_record) const { return moved_[drive_record] == 0; }

  /// Of the voxels in leaves whose lowest voxel lies in the box.
  UpdateCounts counts(const openvdb::CoordBBox& box = openvdb::CoordBBox::inf()) const;

 private:
  enum class Fate : std::uint8_t { kUnseen, kConfirmed, kReplaced, kGone };

  Fate fate_of(const VoxelIndex& voxel, bool is_gone, const VoxelRecord& record, const VoxelFinder& finder,
               const RayTrust& trust) const;

  const VoxelLevel& map_;
  const VoxelLevel& drive_;
  std::vector<std::uint8_t> moved_;
  std::vector<Fate> fates_;
};

/// The voxels of a map after a drive.
VoxelMap voxels_after(const VoxelMap& map, const VoxelMap& drive, const VoxelFates& fates);

/// What the rays of a drive said of a map and of the drive's own map.
struct RaysOfDrive {
  const std::vector<std::uint32_t>& map_passes;    ///< a record of the map
  const std::vector<std::uint32_t>& drive_passes;  ///< a record of the drive
  const VoxelTree& seen_empty;
};

/// What rays said up to now of the voxels of the map as it is after the drive, `after`.
Visibility visibility_after(const VoxelLevel& after, const VoxelLevel& map, const std::optional<Visibility>& before,
                            const VoxelLevel& drive, const RaysOfDrive& rays, const VoxelFates& fates);

/// The voxels of two trees together, without those of a third.
VoxelTree united(const VoxelTree& a, const VoxelTree& b, const VoxelTree& without = VoxelTree{{}});

}  // namespace vdbmap
