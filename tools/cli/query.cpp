// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/command.h"
#include "tools/cli/number_list.h"
#include "tools/cli/output.h"
#include "tools/cli/voxel_text.h"
#include "vdbmap/core/tile_id.h"
#include "vdbmap/core/voxel_query.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

struct QueryOptions {
  std::filesystem::path map;
  std::vector<double> at;
  std::string id;
  std::vector<double> box;
  std::optional<double> level;
};

void add_options(CLI::App& app, QueryOptions& options) {
  app.add_option("MAP", options.map, "The map, or the city, to look into")->type_name("FILE")->required();
  add_number_list(app, "--at", options.at, 3, "X,Y,Z", "The voxel that holds this point");
  app.add_option("--id", options.id, "The voxel of this id: 16 hexadecimal digits")->type_name("ID");
  add_number_list(app, "--box", options.box, 6, "X0,Y0,Z0,X1,Y1,Z1", "All voxels that touch this box");
  app.add_option("--level", options.level, "Edge of the voxels to look at [m] (default: the finest)")->type_name("S");
}

void check_one_question(const QueryOptions& options) {
  const int questions = (options.at.empty() ? 0 : 1) + (options.id.empty() ? 0 : 1) + (options.box.empty() ? 0 : 1);
  if (questions != 1) throw std::invalid_argument("expected exactly one of --at, --id and --box");
}

VoxelId id_of(const std::string& text) {
  if (const std::optional<VoxelId> id = parse_voxel_id(text)) return *id;
  throw std::invalid_argument("--id is '" + text + "', expected 16 hexadecimal digits as in 40000c0000f00003");
}

const VoxelLevel& chosen_level(const VoxelMap& map, const std::optional<double>& voxel_size) {
  if (!voxel_size) return map.finest();
  if (const VoxelLevel* level = find_level(map, *voxel_size)) return *level;
  std::vector<double> sizes;
  for (const VoxelLevel& level : map.levels) sizes.push_back(level.voxel_size());
  throw std::invalid_argument(
      fmt::format("--level is {}, the map has levels of {} m", *voxel_size, fmt::join(sizes, ", ")));
}

std::vector<VoxelInfo> find(const VoxelMap& map, const VoxelLevel& level, const QueryOptions& options) {
  if (!options.box.empty()) {
    return voxels_in_box(map, level, {Eigen::Vector3d(options.box.data()), Eigen::Vector3d(options.box.data() + 3)});
  }
  const std::optional<VoxelInfo> voxel = options.at.empty() ? voxel_with_id(map, level, id_of(options.id))
                                                            : voxel_at(map, level, Eigen::Vector3d(options.at.data()));
  return voxel ? std::vector{*voxel} : std::vector<VoxelInfo>();
}

std::string nothing_found(const VoxelLevel& level, const QueryOptions& options) {
  const std::string where = !options.at.empty()   ? fmt::format("holds {}", fmt::join(options.at, ","))
                            : !options.id.empty() ? "has the id " + options.id
                                                  : fmt::format("touches the box {}", fmt::join(options.box, ","));
  return fmt::format("no voxel of the {:g} m level {}\n", level.voxel_size(), where);
}

// The tile of the point, where ids reach it.
std::optional<TileId> tile_at(const City& city, const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = point - city.manifest.layout.frame.anchor;
  if (!is_addressable(local, voxels_per_metre(city.manifest.layout.voxel_sizes.front()))) return std::nullopt;
  return tile_of_point(local);
}

std::optional<TileId> tile_asked_for(const City& city, const QueryOptions& options) {
  if (!options.at.empty()) return tile_at(city, Eigen::Vector3d(options.at.data()));
  const double voxel_size = options.level.value_or(city.manifest.layout.voxel_sizes.front());
  return tile_of_voxel(voxel_of_id(id_of(options.id)), voxels_per_tile(voxel_size));
}

// Of a city, what may hold the answer.
VoxelMap load_asked_for(const QueryOptions& options) {
  if (!is_city(options.map)) return load_map(options.map);
  City city = open_city(options.map);
  if (!options.box.empty()) {
    return load_window(city,
                       tiles_in_box({Eigen::Vector3d(options.box.data()), Eigen::Vector3d(options.box.data() + 3)}));
  }
  const std::optional<TileId> tile = tile_asked_for(city, options);
  return load_window(city, [&](const CityTile& candidate) { return tile == candidate.id; });
}

ExitCode run(const QueryOptions& options, const CommonOptions& common) {
  check_one_question(options);
  if (!options.id.empty()) id_of(options.id);  // before a map of minutes is read
  const VoxelMap map = load_asked_for(options);
  const VoxelLevel& level = chosen_level(map, options.level);
  const std::vector<VoxelInfo> voxels = find(map, level, options);
  if (common.json) {
    print_json(json_of_voxels(voxels));
  } else {
    print_result(voxels.empty() ? nothing_found(level, options) : text_of_voxels(voxels));
  }
  return voxels.empty() ? ExitCode::kNo : ExitCode::kDone;
}

}  // namespace

Command query_command() {
  return make_command<QueryOptions>("query", "Show the voxels at a point, of an id or in a box",
                                    "vdbmap query map.vdb --at 12.3,4.5,-1.6\n"
                                    "vdbmap query map.vdb --id 40000c0000f00003 --level 1\n"
                                    "vdbmap query city/ --at 552158.95,5802631.83,62.25\n"
                                    "vdbmap query map.vdb --box 10,0,-2,12,3,1 --json",
                                    add_options, run);
}

}  // namespace vdbmap::cli
