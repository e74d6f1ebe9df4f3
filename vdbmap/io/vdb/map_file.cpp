// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_file.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/io/history_text.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/vdb_file.h"
#include "vdbmap/io/vdb/vdb_outline.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/io/vdb/voxel_grid.h"

namespace vdbmap {
namespace {

constexpr const char* kVoxelGridName = "voxels";
constexpr const char* kHistoryName = "history";

bool is_voxel_grid(const std::string& name) { return name.starts_with(kVoxelGridName); }
bool is_coarser_voxel_grid(const std::string& name) { return is_voxel_grid(name) && name != kVoxelGridName; }

// The makers keep references to what they are made of.
void add_level(std::vector<GridMaker>& grids, const VoxelMap& map, const VoxelLevel& level,
               const SaveOptions& options) {
  grids.push_back([&] { return labelled(make_voxel_grid(level, map.has_color), kVoxelGridName, map, level); });
  grids.push_back([&] { return labelled(make_density_grid(level, options.density), "density", map, level); });
  if (map.has_color) grids.push_back([&] { return labelled(make_color_grid(level), "color", map, level); });
}

// Levels are whole multiples of each other and hold the same points.
void check_levels(const VoxelMap& map, const std::filesystem::path& path) {
  for (std::size_t i = 0; i < map.levels.size(); ++i) {
    try {
      voxels_per_metre(map.levels[i].voxel_size());
      if (i > 0) level_factor(map.levels[i - 1].voxel_size(), map.levels[i].voxel_size());
    } catch (const std::invalid_argument& error) {
      throw IoError::malformed(path, error.what());
    }
  }
}

VoxelMap load_levels(const std::filesystem::path& path, const GridFilter& is_wanted) {
  // The fog beside the voxels takes more memory than they do, and tells nothing new.
  VdbContent content = read_vdb(path, is_wanted);
  VoxelMap map;
  map.frame = frame_of_metadata(*content.metadata, path);
  map.label_scheme = label_scheme_of_metadata(*content.metadata);
  for (openvdb::GridBase::Ptr& grid : content.grids) {
    const auto voxels = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(std::exchange(grid, nullptr));
    if (!voxels) continue;
    ReadLevel read = read_voxel_grid(*voxels, path);
    map.has_color |= read.has_color;
    map.levels.push_back(std::move(read.level));
  }
  std::sort(map.levels.begin(), map.levels.end(),
            [](const VoxelLevel& a, const VoxelLevel& b) { return a.voxel_size() < b.voxel_size(); });
  check_levels(map, path);
  return map;
}

}  // namespace

void save_map(const std::filesystem::path& path, const VoxelMap& map, const SaveOptions& options) {
  save_map(path, map, MapExtras(), options);
}

void save_map(const std::filesystem::path& path, const VoxelMap& map, const MapExtras& extras,
              const SaveOptions& options) {
  openvdb::initialize();
  std::vector<GridMaker> grids;
  for (const VoxelLevel& level : map.levels) add_level(grids, map, level, options);
  if (extras.visibility) std::ranges::move(visibility_grids(map, *extras.visibility), std::back_inserter(grids));
  openvdb::MetaMap metadata = metadata_of_map(map);
  if (!extras.history.empty()) metadata.insertMeta(kHistoryName, openvdb::StringMetadata(text_of(extras.history)));
  write_vdb_grid_by_grid(path, grids, metadata);
}

bool is_map_file(const std::filesystem::path& path) {
  const std::string points_type = openvdb::points::PointDataTree::treeType();
  const bool has_voxels = std::ranges::any_of(read_vdb_outline(path).grids, [&](const VdbGridOutline& grid) {
    return is_voxel_grid(grid.name) && grid.type == points_type;
  });
  return has_voxels && has_map_format(*read_vdb(path, [](const std::string&) { return false; }).metadata);
}

VoxelMap load_map(const std::filesystem::path& path) {
  VoxelMap map = load_levels(path, is_voxel_grid);
  if (map.levels.empty()) throw IoError::malformed(path, "holds no grid 'voxels' of a map");
  return map;
}

VoxelMap load_coarser_levels(const std::filesystem::path& path) { return load_levels(path, is_coarser_voxel_grid); }

MapHistory load_history(const std::filesystem::path& path) {
  const VdbContent content = read_vdb(path, [](const std::string&) { return false; });
  const auto history = content.metadata->getMetadata<openvdb::StringMetadata>(kHistoryName);
  return history ? parse_map_history(history->value(), path) : MapHistory();
}

}  // namespace vdbmap
