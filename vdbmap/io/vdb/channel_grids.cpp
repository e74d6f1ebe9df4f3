// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/channel_grids.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/channel_codes.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/voxels_of_file.h"

namespace vdbmap {
namespace {

using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::Int32Grid;
using openvdb::Vec3SGrid;

constexpr std::string_view kCount = "count";

std::string text_of(const VoxelIndex& voxel) {
  std::ostringstream text;
  text << "[" << voxel.x() << ", " << voxel.y() << ", " << voxel.z() << "]";
  return text.str();
}

// Finds grids by name; every refusal names the grid.
class GridFinder {
 public:
  GridFinder(const VdbContent& content, const std::filesystem::path& path) : content_(content), path_(path) {}

  // What follows "count" in the names of the grids that count points.
  std::vector<std::string> suffixes() const {
    std::vector<std::string> suffixes;
    for (const GridBase::Ptr& grid : content_.grids) {
      const std::string name = grid->getName();
      const bool is_count = name == kCount || name.starts_with(std::string(kCount) + "_");
      if (is_count) suffixes.push_back(name.substr(kCount.size()));
    }
    return suffixes;
  }

  ChannelGrids find_level(const std::string& suffix) const {
    ChannelGrids grids;
    grids.suffix = suffix;
    grids.count = required(find_integers("count" + suffix), "count" + suffix);
    grids.voxel_size = size_of_voxels(*grids.count);
    voxelize(*grids.count);
    grids.mean = required(find<Vec3SGrid>("mean" + suffix), "mean" + suffix);
    grids.cov_diag = required(find<Vec3SGrid>("cov_diag" + suffix), "cov_diag" + suffix);
    grids.cov_offdiag = required(find<Vec3SGrid>("cov_offdiag" + suffix), "cov_offdiag" + suffix);
    grids.normal = find<Vec3SGrid>("normal" + suffix);
    grids.color = find<Vec3SGrid>("color" + suffix);
    grids.planarity = find<FloatGrid>("planarity" + suffix);
    grids.intensity = find<FloatGrid>("intensity" + suffix);
    grids.label = find_integers("label" + suffix);
    grids.first_epoch = find_integers("first_epoch" + suffix);
    grids.last_epoch = find_integers("last_epoch" + suffix);
    check_all(grids);
    return grids;
  }

 private:
  [[noreturn]] void fail(const std::string& grid, const std::string& reason) const {
    throw IoError::malformed(path_, "grid '" + grid + "' " + reason);
  }

  GridBase::Ptr find_any(const std::string& name) const {
    GridBase::Ptr found;
    for (const GridBase::Ptr& grid : content_.grids) {
      if (grid->getName() != name) continue;
      if (found) fail(name, "is there twice");
      found = grid;
    }
    return found;
  }

  template <typename Grid>
  typename Grid::Ptr find(const std::string& name) const {
    const GridBase::Ptr grid = find_any(name);
    if (!grid) return nullptr;
    if (!grid->isType<Grid>()) fail(name, "is of type " + grid->valueType() + ", expected " + Grid().valueType());
    return openvdb::gridPtrCast<Grid>(grid);
  }

  Int32Grid::Ptr find_integers(const std::string& name) const {
    const GridBase::Ptr grid = find_any(name);
    return grid && grid->isType<FloatGrid>() ? whole_numbers(*openvdb::gridPtrCast<FloatGrid>(grid))
                                             : find<Int32Grid>(name);
  }

  Int32Grid::Ptr whole_numbers(const FloatGrid& floats) const {
    const auto tree = std::make_shared<openvdb::Int32Tree>(floats.tree(), 0, openvdb::TopologyCopy());
    auto target = tree->beginValueOn();
    for (auto value = floats.cbeginValueOn(); value; ++value, ++target) {
      // 2^31 itself is a float, 2^31 - 1 is not.
      const bool is_whole = std::trunc(*value) == *value && *value >= -0x1p31f && *value < 0x1p31f;
      if (!is_whole) fail(floats.getName(), "holds " + std::to_string(*value) + ", expected a whole number");
      target.setValue(static_cast<std::int32_t>(*value));
    }
    auto grid = Int32Grid::create(tree);
    grid->setName(floats.getName());
    grid->setTransform(floats.transform().copy());
    return grid;
  }

  template <typename GridPtr>
  GridPtr required(const GridPtr& grid, const std::string& name) const {
    if (!grid) throw IoError::malformed(path_, "lacks grid '" + name + "'");
    return grid;
  }

  double size_of_voxels(const GridBase& grid) const {
    const std::optional<double> size = exact_voxel_size(grid.transform().voxelSize().x());
    if (size) return *size;
    fail(grid.getName(), "has voxels of " + std::to_string(grid.transform().voxelSize().x()) + " m, " +
                             std::string(kAllowedVoxelSizes));
  }

  // A tile is a cube of equal voxels that costs next to nothing in the file but much here.
  void voxelize(Int32Grid& grid) const {
    if (grid.tree().activeTileCount() == 0) return;
    const std::uint64_t most = most_voxels_of_file(std::filesystem::file_size(path_));
    if (grid.activeVoxelCount() > most) {
      fail(grid.getName(), "has tiles that make " + std::to_string(grid.activeVoxelCount()) +
                               " voxels of it, a file of its size can hold " + std::to_string(most));
    }
    grid.tree().voxelizeActiveTiles();
  }

  void check_all(const ChannelGrids& grids) const {
    check(grids, grids.count.get());
    check(grids, grids.mean.get());
    check(grids, grids.cov_diag.get());
    check(grids, grids.cov_offdiag.get());
    check(grids, grids.normal.get());
    check(grids, grids.color.get());
    check(grids, grids.planarity.get());
    check(grids, grids.intensity.get());
    check(grids, grids.label.get());
    check(grids, grids.first_epoch.get());
    check(grids, grids.last_epoch.get());
  }

  template <typename Grid>
  void check(const ChannelGrids& grids, const Grid* grid) const {
    if (!grid) return;
    check_transform(*grid, grids.voxel_size);
    check_voxels(*grid, *grids.count);
  }

  void check_transform(const GridBase& grid, double voxel_size) const {
    const std::string problem = problem_of_level_transform(grid.transform(), voxel_size);
    if (!problem.empty()) fail(grid.getName(), problem);
  }

  template <typename Grid>
  void check_voxels(const Grid& grid, const Int32Grid& count) const {
    if (grid.activeVoxelCount() != count.activeVoxelCount()) {
      fail(grid.getName(), "has " + std::to_string(grid.activeVoxelCount()) + " voxels, '" + count.getName() +
                               "' has " + std::to_string(count.activeVoxelCount()));
    }
    const auto values = grid.getConstAccessor();
    for (auto voxel = count.cbeginValueOn(); voxel; ++voxel) {
      typename Grid::ValueType value;
      const bool is_active = values.probeValue(voxel.getCoord(), value);
      const std::string name = grid.getName();
      if (!is_active) fail(name, "lacks voxel " + text_of(voxel.getCoord()) + " of '" + count.getName() + "'");
      if (!is_finite(value)) fail(name, "is not finite in voxel " + text_of(voxel.getCoord()));
    }
  }

  const VdbContent& content_;
  const std::filesystem::path& path_;
};

void check_levels(const std::vector<ChannelGrids>& levels, const std::filesystem::path& path) {
  if (levels.empty()) throw IoError::malformed(path, "lacks grid 'count'");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::string expected = level_suffix(levels[i].voxel_size, i == 0);
    if (levels[i].suffix != expected) {
      throw IoError::malformed(path, "grid 'count" + levels[i].suffix + "' has voxels of " +
                                         std::to_string(levels[i].voxel_size) + " m, so its name must be 'count" +
                                         expected + "'");
    }
    try {
      if (i > 0) level_factor(levels[i - 1].voxel_size, levels[i].voxel_size);
    } catch (const std::invalid_argument& error) {
      throw IoError::malformed(path, error.what());
    }
  }
}

}  // namespace

std::vector<ChannelGrids> find_channel_grids(const VdbContent& content, const std::filesystem::path& path) {
  const GridFinder finder(content, path);
  std::vector<ChannelGrids> levels;
  for (const std::string& suffix : finder.suffixes()) levels.push_back(finder.find_level(suffix));
  std::sort(levels.begin(), levels.end(),
            [](const ChannelGrids& a, const ChannelGrids& b) { return a.voxel_size < b.voxel_size; });
  check_levels(levels, path);
  return levels;
}

}  // namespace vdbmap
