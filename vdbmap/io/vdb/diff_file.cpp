// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/diff_file.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/change/change_colors.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/srgb.h"
#include "vdbmap/core/voxel_assembly.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/vdb_file.h"
#include "vdbmap/io/vdb/vdb_outline.h"
#include "vdbmap/io/vdb/voxel_grid.h"

namespace vdbmap {
namespace {

constexpr const char* kUnobservedGrid = "unobserved";
constexpr const char* kUnchangedName = "voxels_unchanged";

struct Kind {
  const char* grid;
  Change change;
  ChangedVoxels MapDiff::*voxels;
};
constexpr std::array kKinds = {Kind{"appeared", Change::kAppeared, &MapDiff::appeared},
                               Kind{"vanished", Change::kVanished, &MapDiff::vanished},
                               Kind{"changed", Change::kChanged, &MapDiff::changed}};

struct PlacedRecord {
  VoxelKey key;
  VoxelRecord record;
  std::int32_t label;
};

Eigen::Vector3d linear_color_of_change(Change change) {
  const std::uint32_t code = color_code_of(change);
  constexpr std::uint32_t kOf16Bits = 257;  // of 8
  const auto channel = [&](int shift) {
    return linear_from_srgb(static_cast<std::uint16_t>((code >> shift & 255) * kOf16Bits)) / 65535.0;
  };
  return {channel(16), channel(8), channel(0)};
}

// All kinds as one map, in their colours.
VoxelMap map_of(const MapDiff& diff) {
  std::vector<PlacedRecord> placed;
  bool has_labels = false;
  for (const Kind& kind : kKinds) {
    const VoxelLevel& level = (diff.*kind.voxels).level;
    const std::vector<std::int32_t>& labels = level.channels().labels;
    has_labels |= !labels.empty();
    const Eigen::Vector3d color = linear_color_of_change(kind.change);
    for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
      placed.push_back({key_of_voxel(voxel), level.records()[number], labels.empty() ? kNoLabel : labels[number]});
      set_color(placed.back().record, color);
    });
  }
  std::ranges::sort(placed, {}, &PlacedRecord::key);
  VoxelAssembly assembly(diff.voxel_size(), placed.size());
  for (const PlacedRecord& voxel : placed) {
    [[maybe_unused]] const bool in_order = assembly.add(voxel_of_key(voxel.key), voxel.record);
    if (has_labels) assembly.channels().labels.push_back(voxel.label);
  }
  VoxelMap map{diff.frame, {}, /*has_color=*/true, diff.label_scheme};
  map.levels.push_back(assembly.finish());
  return map;
}

openvdb::FloatGrid::Ptr make_unobserved_grid(const MapDiff& diff) {
  const auto grid = std::make_shared<StreamedGrid<openvdb::FloatGrid>>(diff.unobserved, diff.unobserved.num_voxels(),
                                                                       [](std::size_t) { return 1.0f; });
  grid->setTransform(transform_of_level(diff.voxel_size()));
  return grid;
}

bool is_of_diff(const std::string& name) {
  return name == kUnobservedGrid || std::ranges::any_of(kKinds, [&](const Kind& kind) { return name == kind.grid; });
}

const openvdb::FloatGrid& float_grid(const VdbContent& content, const std::string& name,
                                     const std::filesystem::path& path) {
  for (const openvdb::GridBase::Ptr& grid : content.grids) {
    if (grid->getName() == name && grid->isType<openvdb::FloatGrid>()) return static_cast<openvdb::FloatGrid&>(*grid);
  }
  throw IoError::malformed(path, "holds no grid '" + name + "' of a diff");
}

// Calls body(leaf) for the leaves of a grid, in the order of our trees.
template <typename Body>
void for_each_leaf(const openvdb::FloatGrid& grid, const Body& body) {
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) body(*leaf);
}

ChangedVoxels voxels_of_kind(const VoxelMap& map, const openvdb::FloatGrid& grid, const std::filesystem::path& path) {
  const VoxelLevel& level = map.finest();
  const std::vector<std::int32_t>& labels = level.channels().labels;
  const VoxelFinder finder(level);
  VoxelAssembly assembly(level.voxel_size(), 0);
  std::vector<float> confidences;
  for_each_leaf(grid, [&](const auto& leaf) {
    for (auto value = leaf.cbeginValueOn(); value; ++value) {
      const VoxelRecord* record = finder.find(value.getCoord());
      const bool is_share = *value >= 0 && *value <= 1;
      if (!record || !is_share || !assembly.add(value.getCoord(), *record)) {
        throw IoError::malformed(path, "has a voxel in grid '" + grid.getName() + "' that is not one of a diff");
      }
      confidences.push_back(*value);
      const auto number = static_cast<std::size_t>(record - level.records().data());
      if (!labels.empty()) assembly.channels().labels.push_back(labels[number]);
    }
  });
  return {assembly.finish(), std::move(confidences)};
}

VoxelTree tree_of_grid(const openvdb::FloatGrid& grid) {
  LargeVector<VoxelLeaf> leaves;
  for_each_leaf(grid, [&](const auto& leaf) {
    if (leaf.isEmpty()) return;
    leaves.emplace_back(leaf.origin(), false);
    leaves.back().setValueMask(leaf.getValueMask());
  });
  return VoxelTree(std::move(leaves));
}

}  // namespace

void save_diff(const std::filesystem::path& path, const MapDiff& diff, const SaveOptions& options) {
  openvdb::initialize();
  const VoxelMap map = map_of(diff);
  const VoxelLevel& level = map.finest();
  std::vector<GridMaker> grids = {
      [&] { return labelled(make_voxel_grid(level, /*has_color=*/true), "voxels", map, level); },
      [&] { return labelled(make_density_grid(level, options.density), "density", map, level); },
      [&] { return labelled(make_color_grid(level), "color", map, level); },
      [&] { return labelled(make_unobserved_grid(diff), kUnobservedGrid, map, level); }};
  for (const Kind& kind : kKinds) {
    grids.push_back([&, kind] {
      const ChangedVoxels& voxels = diff.*kind.voxels;
      return labelled(make_channel_grid<openvdb::FloatGrid>(
                          voxels.level, [&voxels](std::size_t number) { return voxels.confidences[number]; }),
                      kind.grid, map, level);
    });
  }
  openvdb::MetaMap metadata = metadata_of_map(map);
  metadata.insertMeta(kUnchangedName, openvdb::Int64Metadata(static_cast<std::int64_t>(diff.counts.unchanged)));
  write_vdb_grid_by_grid(path, grids, metadata);
}

bool is_diff_file(const std::filesystem::path& path) {
  const auto grids = read_vdb_outline(path).grids;
  return std::ranges::all_of(kKinds, [&](const Kind& kind) {
    return std::ranges::any_of(grids, [&](const VdbGridOutline& grid) { return grid.name == kind.grid; });
  });
}

MapDiff load_diff(const std::filesystem::path& path) {
  if (!is_diff_file(path))
    throw IoError::malformed(path, "is no diff: it lacks the grids that `vdbmap diff -o` writes");
  const VoxelMap map = load_map(path);
  const VdbContent content = read_vdb(path, is_of_diff);
  MapDiff diff{.frame = map.frame,
               .label_scheme = map.label_scheme,
               .counts = {},
               .appeared = voxels_of_kind(map, float_grid(content, "appeared", path), path),
               .vanished = voxels_of_kind(map, float_grid(content, "vanished", path), path),
               .changed = voxels_of_kind(map, float_grid(content, "changed", path), path),
               .unobserved = tree_of_grid(float_grid(content, kUnobservedGrid, path))};
  diff.counts.appeared = diff.appeared.level.size();
  diff.counts.vanished = diff.vanished.level.size();
  diff.counts.changed = diff.changed.level.size();
  diff.counts.unobserved = diff.unobserved.num_voxels();
  const auto unchanged = content.metadata->getMetadata<openvdb::Int64Metadata>(kUnchangedName);
  if (unchanged) diff.counts.unchanged = static_cast<std::uint64_t>(std::max<std::int64_t>(0, unchanged->value()));
  return diff;
}

}  // namespace vdbmap
