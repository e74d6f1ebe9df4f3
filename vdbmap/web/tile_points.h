// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vdbmap/change/map_diff.h"
#include "vdbmap/core/voxel_level.h"
#include "vdbmap/web/air_faces.h"
#include "vdbmap/web/label_code.h"

namespace vdbmap {

/// A voxel as a point of a tile, in the bytes of the file: 12, in three attributes of four.
struct TilePoint {
  std::array<std::uint8_t, 3> position{};  ///< voxel index from TileBlock::min_index
  std::uint8_t unused = 0;
  std::array<std::uint8_t, 3> color{};  ///< linear, 255 is 1
  std::uint8_t unused_too = 0;
  LabelCode label = 0;
  Change change = Change::kUnchanged;
  AirFaces faces = 0;
  std::uint8_t age = 0;  ///< epochs since the voxel was last seen, 255 or more: 255

  bool operator==(const TilePoint&) const = default;
};
static_assert(sizeof(TilePoint) == 12);

/// Points of a tile within 256 voxels of an index on each axis, in Morton order.
struct TileBlock {
  VoxelIndex min_index;  ///< lowest that a point can have
  std::vector<TilePoint> points;
  std::vector<std::uint32_t> records;  ///< of each point: its number in the level
};

/// What tiles are made of: a level, and what is known of its voxels beside it.
struct TileLevel {
  const VoxelLevel& level;
  std::span<const AirFaces> faces;        ///< a record
  std::span<const std::int32_t> changes;  ///< a record, Change; empty: none known
  LabelScheme label_scheme = LabelScheme::kUnknown;
  std::int32_t newest_epoch = 0;  ///< to which ages count
};

/// The points of some leaves of a level, without those that cannot be seen. Blocks, and the points of each, are in one
/// order whatever that of the leaves.
std::vector<TileBlock> tile_blocks(const TileLevel& source, std::span<const VoxelLeaf* const> leaves);

}  // namespace vdbmap
