// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/visibility_file.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/vdb_outline.h"

namespace vdbmap {
namespace {

constexpr const char* kHitsName = "hits";
constexpr const char* kPassesName = "passes";
constexpr const char* kSeenEmptyName = "seen_empty";
constexpr openvdb::Index64 kMostSeenVoxels = openvdb::Index64{1} << 35;  // a larger number is a damaged file

bool is_visibility_grid(const std::string& name) {
  return name == kHitsName || name == kPassesName || name == kSeenEmptyName;
}

openvdb::GridBase::Ptr make_count_grid(const VoxelLevel& level, const std::vector<std::uint32_t>& counts) {
  return make_channel_grid<openvdb::Int32Grid>(level, [&counts](std::size_t record) {
    constexpr std::uint32_t kMost = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::min(counts[record], kMost));
  });
}

openvdb::GridBase::Ptr make_seen_grid(const VoxelTree& seen, double voxel_size) {
  const auto grid = openvdb::BoolGrid::create(false);
  for (const VoxelLeaf& source : seen.leaves()) {
    auto* leaf = grid->tree().touchLeaf(source.origin());
    leaf->setValueMask(source.getValueMask());
    for (auto voxel = source.getValueMask().beginOn(); voxel; ++voxel) leaf->setValueOnly(voxel.pos(), true);
  }
  grid->pruneGrid();
  grid->setTransform(transform_of_level(voxel_size));
  return grid;
}

// The grids of a file, judged.
class VisibilityReader {
 public:
  VisibilityReader(const std::filesystem::path& path, const VoxelMap& map)
      : path_(path), level_(map.finest()), content_(read_vdb(path, is_visibility_grid)) {}

  std::optional<Visibility> read() const {
    if (content_.grids.empty()) return std::nullopt;
    Visibility visibility;
    visibility.voxel_size = level_.voxel_size();
    visibility.hits = read_counts(kHitsName);
    visibility.passes = read_counts(kPassesName);
    visibility.seen_empty = read_seen();
    return visibility;
  }

 private:
  [[noreturn]] void fail(const std::string& name, const std::string& reason) const {
    throw IoError::malformed(path_, "grid '" + name + "': " + reason);
  }

  template <typename Grid>
  typename Grid::Ptr find(const std::string& name) const {
    for (const openvdb::GridBase::Ptr& grid : content_.grids) {
      if (grid->getName() != name) continue;
      const auto typed = openvdb::gridPtrCast<Grid>(grid);
      if (!typed) fail(name, "is of type " + grid->type());
      const std::string problem = problem_of_level_transform(grid->transform(), level_.voxel_size());
      if (!problem.empty()) fail(name, problem);
      return typed;
    }
    fail(name, "is missing beside the others of what rays saw");
  }

  std::vector<std::uint32_t> read_counts(const std::string& name) const {
    const auto grid = find<openvdb::Int32Grid>(name);
    if (grid->activeVoxelCount() != level_.size()) fail(name, "does not have the voxels of the map");
    const auto values = grid->getConstAccessor();
    std::vector<std::uint32_t> counts;
    counts.reserve(level_.size());
    for_each_voxel(level_, [&](const VoxelIndex& voxel, std::size_t /*record*/) {
      std::int32_t value = 0;
      if (!values.probeValue(voxel, value)) fail(name, "does not have the voxels of the map");
      if (value < 0) fail(name, "has a count below 0");
      counts.push_back(static_cast<std::uint32_t>(value));
    });
    return counts;
  }

  VoxelTree read_seen() const {
    const auto grid = find<openvdb::BoolGrid>(kSeenEmptyName);
    if (grid->activeVoxelCount() > kMostSeenVoxels) fail(kSeenEmptyName, "has too many voxels to be true");
    // Cubes that are one tile, and leaves, in any order.
    std::map<VoxelKey, VoxelLeaf> leaves;
    for (auto value = grid->tree().cbeginValueOn(); value; ++value) {
      openvdb::CoordBBox box;
      value.getBoundingBox(box);
      if (!is_addressable(box.min()) || !is_addressable(box.max()))
        fail(kSeenEmptyName, "leaves the addressable space");
      if (value.isVoxelValue()) {
        leaf_at(leaves, value.getCoord()).setValueOn(value.getCoord());
        continue;
      }
      for (auto corner = openvdb::CoordBBox(box.min() >> 3, box.max() >> 3).begin(); corner; ++corner) {
        leaf_at(leaves, *corner << 3).setValuesOn();
      }
    }
    LargeVector<VoxelLeaf> sorted;
    sorted.reserve(leaves.size());
    for (auto& [key, leaf] : leaves) {
      const VoxelLeaf* occupied = level_.tree().find_leaf(leaf.origin());
      if (occupied && !(occupied->getValueMask() & leaf.getValueMask()).isOff()) {
        fail(kSeenEmptyName, "holds voxels that are occupied");
      }
      sorted.push_back(std::move(leaf));
    }
    return VoxelTree(std::move(sorted));
  }

  static VoxelLeaf& leaf_at(std::map<VoxelKey, VoxelLeaf>& leaves, const VoxelIndex& voxel) {
    const VoxelIndex origin = VoxelTree::origin_of_leaf(voxel);
    return leaves.try_emplace(key_of_voxel(origin), origin, false, false).first->second;
  }

  const std::filesystem::path& path_;
  const VoxelLevel& level_;
  VdbContent content_;
};

}  // namespace

std::vector<GridMaker> visibility_grids(const VoxelMap& map, const Visibility& visibility) {
  const VoxelLevel& level = map.finest();
  return {
      [&] { return labelled(make_count_grid(level, visibility.hits), kHitsName, map, level); },
      [&] { return labelled(make_count_grid(level, visibility.passes), kPassesName, map, level); },
      [&] { return labelled(make_seen_grid(visibility.seen_empty, level.voxel_size()), kSeenEmptyName, map, level); }};
}

std::optional<Visibility> load_visibility(const std::filesystem::path& path, const VoxelMap& map) {
  return VisibilityReader(path, map).read();
}

bool has_visibility(const std::filesystem::path& path) {
  return std::ranges::any_of(read_vdb_outline(path).grids,
                             [](const VdbGridOutline& grid) { return is_visibility_grid(grid.name); });
}

}  // namespace vdbmap
