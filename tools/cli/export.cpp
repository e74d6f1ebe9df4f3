// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <stdexcept>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "vdbmap/io/map_export.h"
#include "vdbmap/io/vdb/map_channels.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

constexpr double kMaxDensity = 65504;  // the largest half-precision number, in which it is stored

struct ExportCommandOptions {
  std::filesystem::path map;
  std::optional<std::filesystem::path> points;
  std::optional<double> level;
  std::optional<std::filesystem::path> channels;
  ChannelOptions channel_options;
};

void add_options(CLI::App& app, ExportCommandOptions& options) {
  app.add_option("MAP", options.map, "The map")->type_name("FILE")->required();
  auto* points =
      app.add_option("OUT", options.points,
                     "Write one point a voxel to this .ply, .las (known classes in ASPRS's numbers) or .xyz file");
  auto* channels = app.add_option("--channels", options.channels, "Write each attribute as a grid to this .vdb file");
  points->type_name("FILE")->excludes(channels);
  channels->type_name("FILE");
  app.add_option("--level", options.level, "Voxel size of the level whose voxels become points [m] (default: finest)")
      ->type_name("S")
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

void export_as_points(const ExportCommandOptions& options, const CommonOptions& common) {
  export_format(*options.points);
  check_output(*options.points, kPointsKind, {options.map});
  const VoxelMap map = load_map(options.map);
  const VoxelLevel& level = chosen_level(map, options);
  export_points(*options.points, map, level);
  print(*options.points, level.size(), common);
}

void export_as_channels(const ExportCommandOptions& options, const CommonOptions& common) {
  check_output(*options.channels, kMapKind, {options.map});
  const VoxelMap map = load_map(options.map);
  export_channels(*options.channels, map, options.channel_options);
  print(*options.channels, map.finest().size(), common);
}

ExitCode run(const ExportCommandOptions& options, const CommonOptions& common) {
  if (!options.points && !options.channels) throw std::invalid_argument("no OUT and no --channels: nothing to export");
  if (options.points) {
    export_as_points(options, common);
  } else {
    export_as_channels(options, common);
  }
  return ExitCode::kDone;
}

}  // namespace

Command export_command() {
  return make_command<ExportCommandOptions>("export", "Write a map as points, or each attribute as a grid",
                                            "vdbmap export map.vdb map.ply\n"
                                            "vdbmap export map.vdb coarse.las --level 1\n"
                                            "vdbmap export map.vdb --channels channels.vdb",
                                            add_options, run);
}

}  // namespace vdbmap::cli
