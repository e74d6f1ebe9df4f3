// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/build_options.h"

#include <limits>
#include <stdexcept>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/number_list.h"
#include "tools/cli/pose_frame.h"
#include "vdbmap/io/las/geodetic_codes.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

constexpr int kMaxEpsg = 999'999;
constexpr double kDefaultVoxelSize = 0.1;  // [m]

void add_map_options(CLI::App& app, MapBuildOptions& options) {
  app.add_option(
         "--voxel-size", options.voxel_size,
         "Edge of the finest voxels [m]; without --levels, a level ten times as large is added where it divides "
         "8 m")
      ->type_name("S")
      ->default_str("0.1");
  add_number_list(app, "--levels", options.levels, 0, "S,S,...",
                  "Edges of the voxels of all levels [m]: each divides 8 m and is a whole multiple of the one before")
      ->default_str("0.1,1");
  app.add_option("--epsg", options.epsg, "EPSG code of the coordinates (default: what LAS files say)")
      ->check(CLI::Range(1, kMaxEpsg).description(""))
      ->type_name("N");
  add_number_list(app, "--anchor", options.anchor, 3, "X,Y,Z",
                  "Origin of the map's local frame, multiples of 64 m (default: near the first point, or where that is "
                  "a stray one near the middle of all)");
  app.add_option("--epoch", options.epoch, "Number of the survey, stored as first and last epoch of every voxel")
      ->check(CLI::Range(0, std::numeric_limits<std::int32_t>::max()).description(""))
      ->type_name("N");
}

void add_range_options(CLI::App& app, MapBuildOptions& options, CLI::Option* poses) {
  app.add_option("--min-range", options.min_range,
                 "Leave out points nearer to the sensor [m], its carrier's for example")
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("R")
      ->needs(poses);
  app.add_option("--max-range", options.max_range, "Leave out points farther from the sensor [m]")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->type_name("R")
      ->needs(poses);
}

// With a voxel size alone: a level ten times as large beside it, unless it does not divide 8 m.
std::vector<double> default_voxel_sizes(double voxel_size) {
  BuildOptions both;
  both.voxel_sizes = {voxel_size, 10 * voxel_size};
  try {
    both.check();
    return both.voxel_sizes;
  } catch (const std::invalid_argument&) {
    return {voxel_size};
  }
}

std::vector<double> chosen_voxel_sizes(const MapBuildOptions& options) {
  if (options.levels.empty()) return default_voxel_sizes(options.voxel_size.value_or(kDefaultVoxelSize));
  if (options.voxel_size && *options.voxel_size != options.levels.front()) {
    throw std::invalid_argument(
        fmt::format("--voxel-size is {} but --levels begins with {}", *options.voxel_size, options.levels.front()));
  }
  return options.levels;
}

std::optional<RangeLimits> range_of(const MapBuildOptions& options) {
  if (!options.min_range && !options.max_range) return std::nullopt;
  const RangeLimits range{options.min_range.value_or(0),
                          options.max_range.value_or(std::numeric_limits<double>::infinity())};
  if (range.min < range.max) return range;
  throw std::invalid_argument(fmt::format("--min-range is {} but --max-range {}", range.min, range.max));
}

}  // namespace

CLI::Option* add_map_build_options(CLI::App& app, MapBuildOptions& options) {
  app.add_option("INPUTS", options.inputs,
                 "Point files, and folders of them: PLY, PCD, LAS, LAZ, KITTI .bin, XYZ/CSV, .pcap")
      ->type_name("PATH")
      ->required();
  CLI::Option* poses = app.add_option("--poses", options.poses,
                                      "A pose for each scan (KITTI or TUM); without, the points are in map coordinates")
                           ->type_name("FILE");
  add_range_options(app, options, poses);
  add_pose_frame(app, options.pose_frame);
  add_scan_selection(app, options.selection);
  add_map_options(app, options);
  add_class_options(app, options.classes);
  add_read_options(app, options.read);
  return poses;
}

BuildOptions build_options(const MapBuildOptions& options) {
  BuildOptions build;
  build.voxel_sizes = chosen_voxel_sizes(options);
  if (!options.anchor.empty()) build.anchor = Eigen::Vector3d(options.anchor.data());
  if (options.epsg && is_geodetic_epsg(*options.epsg)) {
    throw std::invalid_argument(
        fmt::format("--epsg {} is a system of degrees or from the earth's centre, a map needs metres and a z that "
                    "points up: project "
                    "the points first",
                    *options.epsg));
  }
  build.epsg = options.epsg;
  build.epoch = options.epoch;
  build.check();
  return build;
}

BuildOptions build_options_into(const std::filesystem::path& city, const MapBuildOptions& options, float density) {
  BuildOptions build = build_options(options);
  if (!options.anchor.empty())
    throw std::invalid_argument("--anchor cannot be given with --into: a city keeps its own");
  const CityLayout layout = open_city(city).manifest.layout;
  if (density != SaveOptions().density && density != layout.density) {
    throw std::invalid_argument(fmt::format("--density is {}, but the city has {}", density, layout.density));
  }
  if (!options.voxel_size && options.levels.empty()) build.voxel_sizes = layout.voxel_sizes;
  return build;
}

MapFromFilesOptions files_options(const BuildOptions& build, const MapBuildOptions& command,
                                  const CommonOptions& common) {
  MapFromFilesOptions options;
  options.build = build;
  options.inputs.label_scheme = command.classes.scheme();
  options.inputs.dropped_classes = command.classes.dropped;
  options.inputs.read = command.read;
  options.inputs.range = range_of(command);
  options.inputs.reads_ahead = common.num_threads != 1;
  return options;
}

std::vector<std::filesystem::path> named_files(const MapBuildOptions& options) {
  std::vector<std::filesystem::path> files;
  if (options.poses) files.push_back(*options.poses);
  if (options.classes.labels) files.push_back(*options.classes.labels);
  return files;
}

ChosenInputs chosen_inputs(const std::vector<ScanPlace>& all, const MapBuildOptions& options) {
  ChosenInputs chosen = choose_inputs(all, options.selection, options.poses, options.pose_frame);
  if (options.classes.labels) add_label_files(chosen.inputs, *options.classes.labels);
  return chosen;
}

void warn_without_labels(const std::string& label_scheme, bool has_labels) {
  if (!label_scheme.empty() && !has_labels) {
    spdlog::warn("--label-scheme {}: the files hold no labels", label_scheme);
  }
}

}  // namespace vdbmap::cli
