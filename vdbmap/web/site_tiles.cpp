// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_tiles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/web/glb.h"
#include "vdbmap/web/marked_level.h"
#include "vdbmap/web/tile_points.h"
#include "vdbmap/web/voxel_details.h"

namespace vdbmap {
namespace {

// Tiles as they come; those of several threads are added up in the order of the tiles.
struct WrittenTile {
  TileFile file;
  std::bitset<256> label_codes;
};

// Columns of voxels of a level: those of a tile of the same or a higher level.
openvdb::CoordBBox columns_of(const QuadTile& tile, std::int32_t level, const SiteGrid& grid) {
  const std::int32_t side = grid.side << (tile.level - level);
  openvdb::CoordBBox box = openvdb::CoordBBox::inf();
  box.min().x() = tile.x * side;
  box.min().y() = tile.y * side;
  box.max().x() = (tile.x + 1) * side - 1;
  box.max().y() = (tile.y + 1) * side - 1;
  return box;
}

QuadTile block_of_tile(const TileId& tile, const SiteGrid& grid) {
  const auto tiles = static_cast<std::int32_t>(std::lround(grid.edge(grid.block_level) / kTileSize));
  return {grid.block_level, floor_divide(tile.x, tiles), floor_divide(tile.y, tiles)};
}

std::set<QuadTile> blocks_of(const SiteSource& source, const SiteGrid& grid) {
  std::set<QuadTile> blocks;
  for (const TileId& tile : source.tiles()) blocks.insert(block_of_tile(tile, grid));
  return blocks;
}

// What a block needs to be seen as it is in the whole: its own voxels, and around them a voxel of its highest level.
openvdb::CoordBBox box_around(const QuadTile& block, const SiteGrid& grid) {
  const std::int32_t margin = std::max(1 << block.level, 8);
  openvdb::CoordBBox box = columns_of(block, 0, grid);
  for (const int axis : {0, 1}) {
    box.min()[axis] -= margin;
    box.max()[axis] += margin;
  }
  return box;
}

MarkedLevel load_block(const SiteSource& source, const SiteChanges& changes, const QuadTile& block,
                       const SiteGrid& grid) {
  const openvdb::CoordBBox box = box_around(block, grid);
  VoxelLevel level = source.load(box);
  if (!changes.marks) return {std::move(level), std::nullopt};
  const std::optional<VoxelLevel> before = changes.before ? std::optional(changes.before->load(box)) : std::nullopt;
  return with_marks(level, cut_leaves(*changes.marks, box), before ? &*before : nullptr);
}

using LeavesOfTiles = std::map<QuadTile, std::vector<const VoxelLeaf*>>;

LeavesOfTiles leaves_of_tiles(const VoxelLevel& level, std::int32_t number, const openvdb::CoordBBox& own,
                              const SiteGrid& grid) {
  LeavesOfTiles leaves;
  for (const VoxelLeaf& leaf : level.leaves()) {
    if (own.isInside(leaf.origin())) leaves[tile_of_voxel(leaf.origin(), number, grid)].push_back(&leaf);
  }
  return leaves;
}

openvdb::CoordBBox box_of(const std::vector<TileBlock>& blocks) {
  openvdb::CoordBBox box;
  for (const TileBlock& block : blocks) {
    for (const TilePoint& point : block.points) {
      box.expand(block.min_index.offsetBy(point.position[0], point.position[1], point.position[2]));
    }
  }
  return box;
}

class TileWriter {
 public:
  TileWriter(const SiteSource& source, const SiteGrid& grid, SiteFolder& folder)
      : source_(source), grid_(grid), folder_(folder) {}

  // Writes the tiles of a level that lie in `own`; what is around that is looked at only.
  void write_level(const MarkedLevel& marked, std::int32_t number, const openvdb::CoordBBox& own) {
    const VoxelLevel& level = marked.voxels;
    const std::vector<AirFaces> faces = air_faces(level);
    const std::span<const std::int32_t> marks =
        marked.marks ? std::span(marked.marks->channels().labels) : std::span<const std::int32_t>();
    const TileLevel tile_level{level, faces, marks, source_.layout().label_scheme, source_.newest_epoch()};
    const LeavesOfTiles tiles = leaves_of_tiles(level, number, own, grid_);
    const std::vector<std::pair<QuadTile, std::vector<const VoxelLeaf*>>> list(tiles.begin(), tiles.end());
    std::vector<WrittenTile> written(list.size());
    parallel_for(list.size(),
                 [&](std::size_t i) { written[i] = write_tile(tile_level, list[i].first, list[i].second); });
    for (WrittenTile& tile : written) add(std::move(tile));
    if (number == 0) count(tile_level, tiles);
  }

  SiteTiles finish(std::int32_t num_levels) {
    tiles_.num_levels = num_levels;
    return std::move(tiles_);
  }

  // Tiles of a level so far.
  std::vector<QuadTile> tiles_of_level(std::int32_t level) const {
    std::vector<QuadTile> tiles;
    for (const auto& [tile, file] : tiles_.files) {
      if (tile.level == level) tiles.push_back(tile);
    }
    return tiles;
  }

 private:
  WrittenTile write_tile(const TileLevel& level, const QuadTile& tile, const std::vector<const VoxelLeaf*>& leaves) {
    const std::vector<TileBlock> blocks = tile_blocks(level, leaves);
    WrittenTile written;
    written.file.tile = tile;
    written.file.voxels = box_of(blocks);
    for (const TileBlock& block : blocks) {
      written.file.num_points += block.points.size();
      for (const TilePoint& point : block.points) written.label_codes.set(point.label);
    }

    const std::string stem = name_of(tile);
    GlbOptions options;
    options.voxel_size = level.level.voxel_size();
    options.has_color = source_.layout().has_color;
    options.origin = origin_of_tile(tile, written.file.voxels, grid_);
    if (tile.level == 0) {
      options.details = "../details/" + folder_.put_content("details", stem, ".bin", details_of(level, blocks));
    }
    const std::string glb = glb_of(blocks, options);
    written.file.num_bytes = glb.size();
    written.file.name = folder_.put_content("tiles", stem, ".glb", glb);
    return written;
  }

  void add(WrittenTile written) {
    if (written.file.tile.level == 0) tiles_.voxels.expand(written.file.voxels);
    tiles_.label_codes |= written.label_codes;
    tiles_.files.emplace(written.file.tile, std::move(written.file));
  }

  // Voxels that vanished are of the epoch before.
  void count(const TileLevel& source, const LeavesOfTiles& tiles) {
    constexpr auto kVanished = static_cast<std::int32_t>(Change::kVanished);
    for (const auto& [tile, leaves] : tiles) {
      for (const VoxelLeaf* leaf : leaves) {
        for_each_voxel(*leaf, [&](const VoxelIndex&, std::size_t i) {
          if (!source.changes.empty() && source.changes[i] == kVanished) return;
          ++tiles_.num_voxels;
          tiles_.num_points += source.level.records()[i].count;
        });
      }
    }
  }

  const SiteSource& source_;
  const SiteGrid& grid_;
  SiteFolder& folder_;
  SiteTiles tiles_;
};

// Writes the tiles of a block on the levels below its own; returns the block's own level.
MarkedLevel write_block(MarkedLevel level, const QuadTile& block, const SiteGrid& grid, TileWriter& writer) {
  for (std::int32_t number = 0; number < block.level; ++number) {
    writer.write_level(level, number, columns_of(block, number, grid));
    level = level.coarsened();
  }
  const openvdb::CoordBBox own = columns_of(block, block.level, grid);
  level.voxels = cut_leaves(level.voxels, own);
  if (level.marks) level.marks = cut_leaves(*level.marks, own);
  return level;
}

// Levels of different blocks as one.
VoxelLevel joined(std::vector<VoxelLevel> levels) {
  std::vector<VoxelMap> maps;
  for (VoxelLevel& level : levels) {
    maps.emplace_back();
    maps.back().levels.push_back(std::move(level));
  }
  return std::move(splice(maps).levels.front());
}

MarkedLevel joined(std::vector<MarkedLevel> blocks) {
  std::vector<VoxelLevel> voxels, marks;
  for (MarkedLevel& block : blocks) {
    voxels.push_back(std::move(block.voxels));
    if (block.marks) marks.push_back(std::move(*block.marks));
  }
  MarkedLevel whole{joined(std::move(voxels)), std::nullopt};
  if (!marks.empty()) whole.marks = joined(std::move(marks));
  return whole;
}

// Whether tiles will not become fewer by going up: there is one, or those left are the four around the origin.
bool is_top(const std::vector<QuadTile>& tiles) {
  const auto is_at_origin = [](const QuadTile& tile) {
    return (tile.x == 0 || tile.x == -1) && (tile.y == 0 || tile.y == -1);
  };
  return tiles.size() <= 1 || std::ranges::all_of(tiles, is_at_origin);
}

}  // namespace

std::size_t num_blocks(const SiteSource& source) { return blocks_of(source, site_grid(source.voxel_size())).size(); }

SiteTiles write_tiles(const SiteSource& source, const SiteChanges& changes, SiteFolder& folder,
                      const std::function<void()>& on_block_done) {
  const SiteGrid grid = site_grid(source.voxel_size());
  TileWriter writer(source, grid, folder);
  std::vector<MarkedLevel> tops;
  for (const QuadTile& block : blocks_of(source, grid)) {
    tops.push_back(write_block(load_block(source, changes, block, grid), block, grid, writer));
    on_block_done();
  }

  MarkedLevel top = joined(std::move(tops));
  std::int32_t number = grid.block_level;
  for (;; ++number) {
    writer.write_level(top, number, openvdb::CoordBBox::inf());
    if (is_top(writer.tiles_of_level(number))) break;
    top = top.coarsened();
  }
  return writer.finish(number + 1);
}

}  // namespace vdbmap
