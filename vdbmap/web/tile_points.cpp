// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/tile_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vdbmap/web/quad_tile.h"

namespace vdbmap {
namespace {

// A voxel that is seen, by where it comes in its tile.
struct SeenVoxel {
  VoxelIndex block;      // in blocks of 256 from the tile's lowest voxel
  std::uint32_t morton;  // in the block
  std::uint32_t record;

  auto operator<=>(const SeenVoxel& other) const {
    if (block != other.block) return block < other.block ? std::strong_ordering::less : std::strong_ordering::greater;
    return morton <=> other.morton;
  }
  bool operator==(const SeenVoxel& other) const = default;
};

// Spreads the bits of a byte, two zeros behind each.
constexpr std::uint32_t spread_bits(std::uint32_t byte) {
  std::uint32_t bits = (byte | byte << 8) & 0x00f00f;
  bits = (bits | bits << 4) & 0x0c30c3;
  return (bits | bits << 2) & 0x249249;
}

constexpr std::uint32_t gather_bits(std::uint32_t bits) {
  bits &= 0x249249;
  bits = (bits | bits >> 2) & 0x0c30c3;
  bits = (bits | bits >> 4) & 0x00f00f;
  return (bits | bits >> 8) & 0xff;
}

std::uint32_t morton_of(const VoxelIndex& offset) {
  const auto bits = [](std::int32_t i) { return spread_bits(static_cast<std::uint32_t>(i) & 0xff); };
  return bits(offset.x()) << 2 | bits(offset.y()) << 1 | bits(offset.z());
}

std::array<std::uint8_t, 3> place_of_morton(std::uint32_t morton) {
  const auto axis = [&](int shift) { return static_cast<std::uint8_t>(gather_bits(morton >> shift)); };
  return {axis(2), axis(1), axis(0)};
}

// Calls body(voxel, record) for the voxels that are seen.
template <typename Body>
void for_each_seen(const TileLevel& source, std::span<const VoxelLeaf* const> leaves, const Body& body) {
  for (const VoxelLeaf* leaf : leaves) {
    for_each_voxel(*leaf, [&](const VoxelIndex& voxel, std::size_t record) {
      if (source.faces[record] != 0) body(voxel, record);
    });
  }
}

VoxelIndex lowest_voxel(const TileLevel& source, std::span<const VoxelLeaf* const> leaves) {
  VoxelIndex lowest = VoxelIndex::max();
  for_each_seen(source, leaves, [&](const VoxelIndex& voxel, std::size_t) { lowest.minComponent(voxel); });
  return lowest;
}

std::uint8_t byte_of_unit(double value) { return static_cast<std::uint8_t>(std::lround(255 * value)); }

TilePoint point_of(const TileLevel& source, const SeenVoxel& seen) {
  const std::size_t record = seen.record;
  const VoxelChannels& channels = source.level.channels();
  const Eigen::Vector3d color = color_of(source.level.records()[record]);
  TilePoint point;
  point.position = place_of_morton(seen.morton);
  for (int i = 0; i < 3; ++i) point.color[static_cast<std::size_t>(i)] = byte_of_unit(color[i]);
  if (!channels.labels.empty()) point.label = code_of_label(source.label_scheme, channels.labels[record]);
  if (!source.changes.empty()) point.change = static_cast<Change>(source.changes[record]);
  point.faces = source.faces[record];
  if (!channels.last_epochs.empty()) {
    const std::int64_t age = std::int64_t{source.newest_epoch} - channels.last_epochs[record];
    point.age = static_cast<std::uint8_t>(std::clamp<std::int64_t>(age, 0, std::numeric_limits<std::uint8_t>::max()));
  }
  return point;
}

}  // namespace

std::vector<TileBlock> tile_blocks(const TileLevel& source, std::span<const VoxelLeaf* const> leaves) {
  const VoxelIndex lowest = lowest_voxel(source, leaves);
  std::vector<SeenVoxel> seen;
  for_each_seen(source, leaves, [&](const VoxelIndex& voxel, std::size_t record) {
    const VoxelIndex offset = voxel - lowest;
    seen.push_back({offset >> 8, morton_of(offset), static_cast<std::uint32_t>(record)});
  });
  std::ranges::sort(seen);

  std::vector<TileBlock> blocks;
  const VoxelIndex* last = nullptr;
  for (const SeenVoxel& voxel : seen) {
    if (last == nullptr || *last != voxel.block) blocks.push_back({lowest + (voxel.block << 8), {}, {}});
    last = &voxel.block;
    blocks.back().points.push_back(point_of(source, voxel));
    blocks.back().records.push_back(voxel.record);
  }
  return blocks;
}

}  // namespace vdbmap
