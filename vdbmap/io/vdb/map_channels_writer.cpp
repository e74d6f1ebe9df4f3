// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "vdbmap/io/vdb/channel_codes.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_grids.h"
#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

float exact_float(std::int32_t value) {
  const auto rounded = static_cast<float>(value);
  if (static_cast<double>(rounded) != value) {
    throw std::invalid_argument("a float cannot hold " + std::to_string(value) + " exactly; export integers as Int32");
  }
  return rounded;
}

// Collects the channels of one level.
class LevelExport {
 public:
  LevelExport(const VoxelMap& map, const VoxelLevel& level, const ChannelOptions& options)
      : map_(map), level_(level), options_(options) {}

  /// The makers keep a reference to this.
  std::vector<GridMaker> grids() {
    add("density", [this] { return make_density_grid(level_, options_.density); });
    add_moments();
    add_vectors("normal", openvdb::VEC_COVARIANT_NORMALIZE, normal_value_of);
    add_floats("planarity", [this](std::size_t i) { return planarity_value_of(level_.records()[i]); });
    if (map_.has_color) add_vectors("color", openvdb::VEC_INVARIANT, color_value_of);
    add_optional_channels();
    return std::move(grids_);
  }

 private:
  template <typename Make>
  void add(const std::string& name, const Make& make) {
    grids_.push_back([this, name, make] { return labelled(make(), name, map_, level_); });
  }

  template <typename ValueOf>
  void add_floats(const std::string& name, const ValueOf& value_of) {
    add(name, [this, value_of] { return make_channel_grid<openvdb::FloatGrid>(level_, value_of); });
  }

  template <typename ValueOf>
  void add_vectors(const std::string& name, openvdb::VecType type, const ValueOf& value_of) {
    add(name, [this, type, value_of] {
      const auto grid =
          make_channel_grid<openvdb::Vec3SGrid>(level_, [&](std::size_t i) { return value_of(level_.records()[i]); });
      grid->setVectorType(type);
      return grid;
    });
  }

  template <typename ValueOf>
  void add_integers(const std::string& name, const ValueOf& value_of) {
    if (options_.integers_as_float) {
      add_floats(name, [value_of](std::size_t i) { return exact_float(value_of(i)); });
    } else {
      add(name, [this, value_of] { return make_channel_grid<openvdb::Int32Grid>(level_, value_of); });
    }
  }

  void add_moments() {
    add_integers("count", [this](std::size_t i) { return static_cast<std::int32_t>(level_.records()[i].count); });
    add_vectors("mean", openvdb::VEC_INVARIANT,
                [this](const VoxelRecord& record) { return mean_offset_of(record, level_.voxel_size()); });
    add_vectors("cov_diag", openvdb::VEC_INVARIANT,
                [](const VoxelRecord& record) { return openvdb::Vec3f(record.covariance.data()); });
    add_vectors("cov_offdiag", openvdb::VEC_INVARIANT,
                [](const VoxelRecord& record) { return openvdb::Vec3f(record.covariance.data() + 3); });
  }

  void add_optional_channels() {
    for_each_channel([&]<typename Value>(const char* name, std::vector<Value> VoxelChannels::*channel) {
      const std::vector<Value>& values = level_.channels().*channel;
      if (values.empty()) return;
      const auto value_of = [&values](std::size_t i) { return values[i]; };
      if constexpr (std::is_integral_v<Value>) {
        add_integers(name, value_of);
      } else {
        add_floats(name, value_of);
      }
    });
  }

  const VoxelMap& map_;
  const VoxelLevel& level_;
  const ChannelOptions& options_;
  std::vector<GridMaker> grids_;
};

}  // namespace

void export_channels(const std::filesystem::path& path, const VoxelMap& map, const ChannelOptions& options) {
  openvdb::initialize();
  std::vector<GridMaker> grids;
  std::deque<LevelExport> levels;  // which stay in their places
  for (const VoxelLevel& level : map.levels) {
    for (GridMaker& grid : levels.emplace_back(map, level, options).grids()) grids.push_back(std::move(grid));
  }
  write_vdb_grid_by_grid(path, grids, metadata_of_map(map));
}

}  // namespace vdbmap
