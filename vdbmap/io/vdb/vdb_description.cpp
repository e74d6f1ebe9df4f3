// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/vdb_description.h"

#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

TextMetadata text_of(const openvdb::MetaMap& metadata) {
  TextMetadata text;
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
    text.emplace_back(entry->first, entry->second->str());
  }
  return text;
}

GridDescription describe(const openvdb::GridBase& grid) {
  GridDescription description;
  description.name = grid.getName();
  description.type = grid.valueType();
  description.grid_class = openvdb::GridBase::gridClassToString(grid.getGridClass());
  description.num_active_voxels = grid.activeVoxelCount();
  if (!grid.empty() && description.num_active_voxels > 0) {
    description.bounding_box = grid.evalActiveVoxelBoundingBox();
  }
  description.voxel_size = grid.voxelSize();
  description.is_linear = grid.transform().isLinear();
  description.metadata = text_of(grid);
  return description;
}

}  // namespace

VdbDescription describe_vdb(const std::filesystem::path& path) {
  const VdbContent content = read_vdb(path);
  VdbDescription description;
  description.metadata = text_of(*content.metadata);
  for (const openvdb::GridBase::Ptr& grid : content.grids) description.grids.push_back(describe(*grid));
  return description;
}

}  // namespace vdbmap
