// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/change_marks.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/voxel_assembly.h"
#include "vdbmap/core/voxel_block.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

// Later ones win.
constexpr std::array<std::pair<const char*, ChangeMark>, 4> kMarkGrids = {{{"changed", ChangeMark::kChanged},
                                                                           {"unobserved", ChangeMark::kUnobserved},
                                                                           {"vanished", ChangeMark::kVanished},
                                                                           {"appeared", ChangeMark::kAppeared}}};

bool is_mark_grid(const std::string& name) {
  return std::ranges::any_of(kMarkGrids, [&](const auto& kind) { return name == kind.first; });
}

const openvdb::FloatGrid& mark_grid(const VdbContent& content, const std::string& name,
                                    const std::filesystem::path& path) {
  for (const openvdb::GridBase::Ptr& grid : content.grids) {
    if (grid->getName() == name && grid->isType<openvdb::FloatGrid>()) return static_cast<openvdb::FloatGrid&>(*grid);
  }
  throw IoError::malformed(path, "is no diff: it has no grid '" + name + "'");
}

std::map<VoxelKey, ChangeMark> marks_of(const VdbContent& content, const std::filesystem::path& path) {
  std::map<VoxelKey, ChangeMark> marks;
  for (const auto& [name, mark] : kMarkGrids) {
    const openvdb::FloatGrid& grid = mark_grid(content, name, path);
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
      for (auto value = leaf->cbeginValueOn(); value; ++value) {
        if (!is_addressable(value.getCoord())) throw IoError::malformed(path, "has voxels beyond what ids reach");
        marks[key_of_voxel(value.getCoord())] = mark;
      }
    }
  }
  return marks;
}

}  // namespace

ChangeMarks load_change_marks(const std::filesystem::path& path) {
  const VoxelMap map = load_map(path);
  if (map.levels.empty()) throw IoError::malformed(path, "is no diff: it has no level of voxels");
  const std::map<VoxelKey, ChangeMark> marks = marks_of(read_vdb(path, is_mark_grid), path);
  const VoxelFinder finder(map.finest());
  VoxelAssembly assembly(map.finest().voxel_size(), marks.size());
  for (const auto& [key, mark] : marks) {
    const VoxelIndex voxel = voxel_of_key(key);
    const VoxelRecord* const record = finder.find(voxel);
    [[maybe_unused]] const bool in_order = assembly.add(voxel, record ? *record : VoxelRecord());
    assembly.channels().labels.push_back(static_cast<std::int32_t>(mark));
  }
  return {map.frame, assembly.finish()};
}

}  // namespace vdbmap
