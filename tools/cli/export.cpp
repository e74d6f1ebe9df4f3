// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/city_output.h"
#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/number_list.h"
#include "tools/cli/output.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/map_export.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/city_window.h"
#include "vdbmap/store/seen_window.h"

namespace vdbmap::cli {
namespace {

constexpr double kMaxDensity = 65504;  // the largest half-precision number, in which it is stored

struct ExportCommandOptions {
  std::filesystem::path map;
  std::optional<std::filesystem::path> points;
  std::optional<double> level;
  std::vector<double> box;
  std::optional<std::filesystem::path> channels;
  ChannelOptions channel_options;
};

void add_options(CLI::App& app, ExportCommandOptions& options) {
  app.add_option("MAP", options.map, "The map, or the city")->type_name("FILE")->required();
  auto* points =
      app.add_option("OUT", options.points,
                     "Write one point a voxel to this .ply, .las (known classes in ASPRS's numbers) or .xyz file; or "
                     "the whole map to this .vdb file or, with a slash at its end, as a city into this folder");
  auto* channels = app.add_option("--channels", options.channels, "Write each attribute as a grid to this .vdb file");
  points->type_name("FILE")->excludes(channels);
  channels->type_name("FILE");
  app.add_option("--level", options.level, "Voxel size of the level whose voxels become points [m] (default: finest)")
      ->type_name("S")
      ->excludes(channels);
  add_number_list(app, "--box", options.box, 6, "X0,Y0,Z0,X1,Y1,Z1", "Only the voxels whose mean lies in this box")
      ->excludes(channels);
  app.add_option("--density", options.channel_options.density, "Density of the fog that renderers see [1/m]")
      ->check(CLI::Range(0.0, kMaxDensity).description(""))
      ->type_name("D")
      ->capture_default_str()
      ->needs(channels);
  app.add_flag("--integers-as-float", options.channel_options.integers_as_float,
               "Whole numbers in float grids, for readers without Int32, like Debian's python3-openvdb")
      ->needs(channels);
}

const VoxelLevel& chosen_level(const VoxelMap& map, const ExportCommandOptions& options) {
  if (!options.level) return map.finest();
  if (const VoxelLevel* level = find_level(map, *options.level)) return *level;
  throw std::invalid_argument(fmt::format("{} has no level of {} m", options.map.string(), *options.level));
}

void print(const std::filesystem::path& file, std::size_t num_voxels, const CommonOptions& common) {
  if (common.json) {
    print_json({{"file", file.string()}, {"num_voxels", num_voxels}});
  } else {
    print_result(fmt::format("{}: {} voxels\n", file.string(), num_voxels));
  }
}

bool is_whole_map_output(const std::filesystem::path& output) {
  return is_city_output(output) || lower_case(output.extension().string()) == ".vdb";
}

void check_whole_map_options(const ExportCommandOptions& options) {
  if (options.level || !options.box.empty()) {
    throw std::invalid_argument("--level and --box choose points, but the output is a whole map");
  }
}

// Of a city the tiles that the box reaches into, else the whole map.
VoxelMap load_exported(const ExportCommandOptions& options) {
  if (options.box.empty() || !is_city(options.map)) return load_map_or_city(options.map);
  City city = open_city(options.map);
  return load_window(city,
                     tiles_in_box({Eigen::Vector3d(options.box.data()), Eigen::Vector3d(options.box.data() + 3)}));
}

void export_as_points(const ExportCommandOptions& options, const CommonOptions& common) {
  export_format(*options.points);
  check_output(*options.points, kPointsKind, {options.map});
  const VoxelMap map = load_exported(options);
  const VoxelLevel& level = chosen_level(map, options);
  if (options.box.empty()) {
    export_points(*options.points, map, level);
    print(*options.points, level.size(), common);
  } else {
    const Extent box{Eigen::Vector3d(options.box.data()), Eigen::Vector3d(options.box.data() + 3)};
    print(*options.points, export_points_in_box(*options.points, map, level, box), common);
  }
}

MapHistory history_of(const CityManifest& manifest) { return {manifest.epochs, manifest.sources}; }

// From a folder to a file, from a file to a folder.
void export_whole_map(const ExportCommandOptions& options, const CommonOptions& common) {
  check_whole_map_options(options);
  if (is_city_output(*options.points)) {
    const LoadedMap loaded = load_seen_map_or_city(options.map);
    const MapHistory history =
        is_city(options.map) ? history_of(open_city(options.map).manifest) : load_history(options.map);
    save_city(city_folder(*options.points), loaded.map, {loaded.visibility, history});
    return print(*options.points, loaded.map.finest().size(), common);
  }
  check_output(*options.points, kMapKind, {options.map});
  if (!is_city(options.map)) throw std::invalid_argument(options.points->string() + ": the map is such a file already");
  City city = open_city(options.map);
  const LoadedMap loaded = load_seen_window(city, [](const CityTile&) { return true; });
  // Of a city of which only its sources are known, a map in one file says nothing.
  const MapHistory history = city.manifest.epochs.empty() ? MapHistory() : history_of(city.manifest);
  save_map(*options.points, loaded.map, {loaded.visibility, history}, {city.manifest.layout.density});
  print(*options.points, loaded.map.finest().size(), common);
}

void export_as_channels(const ExportCommandOptions& options, const CommonOptions& common) {
  check_output(*options.channels, kMapKind, {options.map});
  const VoxelMap map = load_map_or_city(options.map);
  export_channels(*options.channels, map, options.channel_options);
  print(*options.channels, map.finest().size(), common);
}

ExitCode run(const ExportCommandOptions& options, const CommonOptions& common) {
  if (!options.points && !options.channels) throw std::invalid_argument("no OUT and no --channels: nothing to export");
  if (options.points && is_whole_map_output(*options.points)) {
    export_whole_map(options, common);
  } else if (options.points) {
    export_as_points(options, common);
  } else {
    export_as_channels(options, common);
  }
  return ExitCode::kDone;
}

}  // namespace

Command export_command() {
  return make_command<ExportCommandOptions>(
      "export", "Write a map as points, in one file, as a city, or each attribute as a grid",
      "vdbmap export map.vdb map.ply\n"
      "vdbmap export map.vdb coarse.las --level 1\n"
      "vdbmap export city/ part.ply --box 10,0,-2,60,30,20\n"
      "vdbmap export city/ one.vdb\n"
      "vdbmap export map.vdb city/\n"
      "vdbmap export map.vdb --channels channels.vdb",
      add_options, run);
}

}  // namespace vdbmap::cli
