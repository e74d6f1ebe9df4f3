// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/voxel_assembly.h"
#include "vdbmap/io/vdb/channel_codes.h"
#include "vdbmap/io/vdb/channel_grids.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

constexpr double kCoarserVoxelSize = 1.0;  // [m] of the level that a file of other programs gets

// Makes a level of the channels.
class LevelImport {
 public:
  LevelImport(const ChannelGrids& grids, const std::filesystem::path& path) : grids_(grids), path_(path) {}

  VoxelLevel level() const {
    VoxelAssembly assembly(grids_.voxel_size, grids_.count->activeVoxelCount());
    add_records(assembly);
    read_channel(grids_.intensity, assembly.channels().intensities);
    read_channel(grids_.label, assembly.channels().labels);
    read_channel(grids_.first_epoch, assembly.channels().first_epochs);
    read_channel(grids_.last_epoch, assembly.channels().last_epochs);
    VoxelLevel level = assembly.finish();
    if (!grids_.normal || !grids_.planarity) compute_normals(level);
    read_normals(level);
    return level;
  }

 private:
  [[noreturn]] void fail(const std::string& channel, const VoxelIndex& voxel, const std::string& reason) const {
    throw IoError::malformed(path_, "grid '" + channel + grids_.suffix + "', voxel [" + std::to_string(voxel.x()) +
                                        ", " + std::to_string(voxel.y()) + ", " + std::to_string(voxel.z()) +
                                        "]: " + reason);
  }

  void add_records(VoxelAssembly& assembly) const {
    const auto mean = grids_.mean->getConstAccessor();
    const auto cov_diag = grids_.cov_diag->getConstAccessor();
    const auto cov_offdiag = grids_.cov_offdiag->getConstAccessor();
    const auto color = grids_.color ? grids_.color : openvdb::Vec3SGrid::create();
    const auto colors = color->getConstAccessor();
    for (auto count = grids_.count->cbeginValueOn(); count; ++count) {
      const VoxelIndex voxel = count.getCoord();
      check(voxel, *count, mean.getValue(voxel));
      VoxelRecord record;
      record.count = static_cast<std::uint32_t>(*count);
      const openvdb::Vec3f& d = cov_diag.getValue(voxel);
      const openvdb::Vec3f& o = cov_offdiag.getValue(voxel);
      const std::string_view problem = covariance_problem(d, o, grids_.voxel_size);
      if (!problem.empty()) fail("cov_diag", voxel, std::string(problem));
      record.covariance = {d.x(), d.y(), d.z(), o.x(), o.y(), o.z()};
      set_mean_offset(record, mean.getValue(voxel), grids_.voxel_size);
      set_color_value(record, colors.getValue(voxel));
      if (!assembly.add(voxel, record)) fail("count", voxel, "comes out of order");
    }
  }

  void check(const VoxelIndex& voxel, std::int32_t count, const openvdb::Vec3f& mean) const {
    if (!is_addressable(voxel)) fail("count", voxel, "beyond the addressable range");
    if (count < 1) fail("count", voxel, "count is " + std::to_string(count) + ", expected 1 or more");
    // Others round differently.
    const double limit = 0.5 * grids_.voxel_size * (1 + 1.0 / kMeanSteps);
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(mean[axis]) > limit) {
        fail("mean", voxel, "offset of " + std::to_string(mean[axis]) + " m leaves the voxel");
      }
    }
  }

  template <typename GridPtr, typename Value>
  void read_channel(const GridPtr& grid, std::vector<Value>& values) const {
    if (!grid) return;
    const auto source = grid->getConstAccessor();
    values.reserve(grids_.count->activeVoxelCount());
    for (auto voxel = grids_.count->cbeginValueOn(); voxel; ++voxel) {
      values.push_back(source.getValue(voxel.getCoord()));
    }
  }

  void read_normals(VoxelLevel& level) const {
    if (grids_.normal) {
      const auto normals = grids_.normal->getConstAccessor();
      for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
        const openvdb::Vec3f& normal = normals.getValue(voxel);
        if (normal.isZero()) fail("normal", voxel, "has no direction");
        set_normal_value(level.records()[number], normal);
      });
    }
    if (grids_.planarity) {
      const auto planarities = grids_.planarity->getConstAccessor();
      for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
        set_planarity_value(level.records()[number], planarities.getValue(voxel));
      });
    }
  }

  const ChannelGrids& grids_;
  const std::filesystem::path& path_;
};

// Metadata of another program made complete: whole anchors may be integers there, and unknown ones are 0.
openvdb::MetaMap complete_metadata(const openvdb::MetaMap& stated) {
  openvdb::MetaMap metadata = metadata_of_map(VoxelMap());
  for (auto entry = stated.beginMeta(); entry != stated.endMeta(); ++entry) {
    const auto& [name, value] = *entry;
    const bool is_whole_anchor =
        name.starts_with("anchor_") && value->typeName() == openvdb::Int32Metadata().typeName();
    metadata.removeMeta(name);
    if (is_whole_anchor) {
      const std::int32_t whole = static_cast<const openvdb::Int32Metadata&>(*value).value();
      metadata.insertMeta(name, openvdb::DoubleMetadata(whole));
    } else {
      metadata.insertMeta(name, *value);
    }
  }
  return metadata;
}

MapFrame read_frame(const openvdb::MetaMap& metadata, const std::filesystem::path& path) {
  return frame_of_metadata(has_map_format(metadata) ? metadata : complete_metadata(metadata), path);
}

// Levels of one file hold the same points and the same attributes.
void check_levels_agree(const ChannelGrids& fine, const ChannelGrids& coarse, const VoxelMap& map,
                        const std::filesystem::path& path) {
  const auto check_both = [&](const std::string& name, bool in_fine, bool in_coarse) {
    if (in_fine && !in_coarse) throw IoError::malformed(path, "lacks grid '" + name + coarse.suffix + "'");
    if (!in_fine && in_coarse)
      throw IoError::malformed(path, "lacks grid '" + name + "' beside that of " + coarse.suffix);
  };
  check_both("color", fine.color != nullptr, coarse.color != nullptr);
  check_both("intensity", fine.intensity != nullptr, coarse.intensity != nullptr);
  check_both("label", fine.label != nullptr, coarse.label != nullptr);
  check_both("first_epoch", fine.first_epoch != nullptr, coarse.first_epoch != nullptr);
  check_both("last_epoch", fine.last_epoch != nullptr, coarse.last_epoch != nullptr);

  const std::size_t expected = num_points(map.finest());
  const std::size_t found = num_points(map.levels.back());
  if (found != expected) {
    throw IoError::malformed(path, "grid 'count" + coarse.suffix + "' counts " + std::to_string(found) +
                                       " points, 'count' " + std::to_string(expected));
  }
}

void add_default_level(VoxelMap& map) {
  const double factor = kCoarserVoxelSize / map.finest().voxel_size();
  const bool is_multiple = factor > 1.5 && std::abs(factor - std::round(factor)) < 1e-9 * factor;
  if (is_multiple) add_coarser_levels(map, {map.finest().voxel_size(), kCoarserVoxelSize});
}

}  // namespace

VoxelMap import_channels(const std::filesystem::path& path) {
  const VdbContent content = read_vdb(path);
  const std::vector<ChannelGrids> levels = find_channel_grids(content, path);
  VoxelMap map;
  map.frame = read_frame(*content.metadata, path);
  map.label_scheme = label_scheme_of_metadata(*content.metadata);
  map.has_color = levels.front().color != nullptr;
  for (const ChannelGrids& grids : levels) {
    map.levels.push_back(LevelImport(grids, path).level());
    check_levels_agree(levels.front(), grids, map, path);
  }
  if (levels.size() == 1 && !has_map_format(*content.metadata)) add_default_level(map);
  return map;
}

}  // namespace vdbmap
