// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_sums.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/sums_file.h"

namespace vdbmap {
namespace {

constexpr std::int32_t kBlockEdge = 1 << kBlockBits;

std::size_t bytes_of(const BlockContent& content) {
  return content.sums.capacity() * sizeof(KeyedSums) + content.votes.capacity() * sizeof(LabelVotes);
}

// Where a part of a block of points goes.
struct BlockPart {
  TileId tile;
  BlockKey block;
  BlockContent content;
};

std::vector<BlockPart> parts_of(const SortedPoints& points, std::int32_t margin, std::int32_t per_tile) {
  std::vector<std::map<TileId, BlockContent>> splits(points.num_blocks());
  parallel_for(splits.size(), [&](std::size_t i) {
    splits[i] = split_by_tile(points.block(i), {points.fold(i), points.votes(i)}, margin, per_tile);
  });
  std::vector<BlockPart> parts;
  for (std::size_t i = 0; i < splits.size(); ++i) {
    for (auto& [tile, content] : splits[i]) parts.push_back({tile, points.block(i), std::move(content)});
  }
  return parts;
}

}  // namespace

std::map<TileId, BlockContent> split_by_tile(BlockKey block, BlockContent content, std::int32_t margin,
                                             std::int32_t voxels_per_tile) {
  const VoxelIndex origin = origin_of_block(block);
  const TileRange all = tiles_around(origin, kBlockEdge, margin, voxels_per_tile);
  std::map<TileId, BlockContent> parts;
  if (all.low == all.high) {
    parts[all.low] = std::move(content);
    return parts;
  }
  const auto for_each_tile_of = [&](KeyInBlock key, const auto& body) {
    const TileRange range = tiles_around(origin + leaf_origin_in_block(key), VoxelLeaf::DIM, margin, voxels_per_tile);
    for (std::int32_t x = range.low.x; x <= range.high.x; ++x) {
      for (std::int32_t y = range.low.y; y <= range.high.y; ++y) body(parts[{x, y}]);
    }
  };
  for (const KeyedSums& voxel : content.sums) {
    for_each_tile_of(voxel.key, [&](BlockContent& part) { part.sums.push_back(voxel); });
  }
  for (const LabelVotes& votes : content.votes) {
    const KeyInBlock key = key_in_block(voxel_of_key(votes.voxel));
    for_each_tile_of(key, [&](BlockContent& part) { part.votes.push_back(votes); });
  }
  return parts;
}

TileSums::TileSums(const std::vector<double>& voxel_sizes, std::filesystem::path spill_folder, std::size_t most_bytes)
    : voxels_per_tile_(voxels_per_tile(voxel_sizes.front())),
      margin_(margin_in_voxels(neighbor_margin(voxel_sizes), voxel_sizes.front())),
      spill_folder_(std::move(spill_folder)),
      most_bytes_(most_bytes) {}

void TileSums::add(const SortedPoints& points) {
  ++num_adds_;
  std::vector<BlockPart> parts = parts_of(points, margin_, voxels_per_tile_);
  std::vector<BlockContent*> targets;
  for (const BlockPart& part : parts) {
    Tile& tile = tiles_[part.tile];
    tile.last_used = num_adds_;
    targets.push_back(&tile.blocks[part.block]);
    tile.num_bytes -= bytes_of(*targets.back());
    num_bytes_ -= bytes_of(*targets.back());
  }
  parallel_for(parts.size(), [&](std::size_t i) { add_content(*targets[i], std::move(parts[i].content)); });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    tiles_[parts[i].tile].num_bytes += bytes_of(*targets[i]);
    num_bytes_ += bytes_of(*targets[i]);
  }
  if (num_bytes_ > most_bytes_) spill_beyond_limit();
}

void TileSums::spill_beyond_limit() {
  using Candidate = std::pair<const TileId, Tile>;
  std::vector<Candidate*> candidates;
  for (Candidate& tile : tiles_) {
    if (tile.second.num_bytes > 0) candidates.push_back(&tile);
  }
  // Of tiles that are used alike, the largest first: fewer and larger pieces.
  std::ranges::sort(candidates, {}, [](const Candidate* tile) {
    return std::tuple(tile->second.last_used, ~tile->second.num_bytes, tile->first);
  });
  std::size_t num_left = num_bytes_;
  std::size_t num_chosen = 0;
  for (; num_chosen < candidates.size() && num_left > most_bytes_ / 4 * 3; ++num_chosen) {
    num_left -= candidates[num_chosen]->second.num_bytes;
  }
  parallel_for(num_chosen, [&](std::size_t i) {
    auto& [id, tile] = *candidates[i];
    append_sums(file_of(id), tile.blocks);
    tile.blocks.clear();
    tile.has_file = true;
  });
  for (std::size_t i = 0; i < num_chosen; ++i) {
    num_spilled_bytes_ += candidates[i]->second.num_bytes;
    num_bytes_ -= std::exchange(candidates[i]->second.num_bytes, 0);
  }
}

std::filesystem::path TileSums::file_of(const TileId& tile) const { return spill_folder_ / tile_name(tile); }

std::vector<TileId> TileSums::tiles() const {
  std::vector<TileId> ids;
  for (const auto& [id, tile] : tiles_) ids.push_back(id);
  return ids;
}

VoxelBlocks TileSums::take(const TileId& id) {
  Tile& tile = tiles_.at(id);
  VoxelBlocks blocks = std::exchange(tile.blocks, {});
  if (tile.has_file) {
    add_sums_of_file(file_of(id), blocks);
    std::filesystem::remove(file_of(id));
    tile.has_file = false;
  }
  return blocks;
}

}  // namespace vdbmap
