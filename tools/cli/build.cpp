// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/build_city.h"
#include "tools/cli/build_inputs.h"
#include "tools/cli/build_report.h"
#include "tools/cli/city_output.h"
#include "tools/cli/class_options.h"
#include "tools/cli/command.h"
#include "tools/cli/date_option.h"
#include "tools/cli/map_output.h"
#include "tools/cli/number_list.h"
#include "tools/cli/pose_frame.h"
#include "tools/cli/posed_drive.h"
#include "tools/cli/progress.h"
#include "tools/cli/reading.h"
#include "tools/cli/scan_selection.h"
#include "tools/cli/survey_rays.h"
#include "vdbmap/change/map_visibility.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/las/geodetic_codes.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/source_hash.h"

namespace vdbmap::cli {
namespace {

constexpr int kMaxEpsg = 999'999;
constexpr double kDefaultVoxelSize = 0.1;  // [m]

// What is said of the rays by which the points were measured.
struct RayOptions {
  std::optional<std::filesystem::path> trajectory;
  std::vector<double> lever_arm;
  bool of_scans = false;  // whose poses are given

  bool are_wanted() const { return trajectory || of_scans; }
};

struct BuildCommandOptions {
  std::vector<std::filesystem::path> inputs;
  std::optional<std::filesystem::path> poses;
  PoseFrame pose_frame = PoseFrame::kUnknown;
  ScanSelection selection;
  std::optional<double> voxel_size;
  std::vector<double> levels;
  std::vector<double> anchor;
  std::optional<int> epsg;
  std::optional<std::int32_t> epoch;
  std::string date;
  ClassOptions classes;
  std::optional<double> min_range;  // [m]
  std::optional<double> max_range;  // [m]
  RayOptions rays;
  ReadOptions read;
  MapOutput output;
  CityOutput city;

  bool makes_city() const { return city.into || is_city_output(output.file); }
};

void add_map_options(CLI::App& app, BuildCommandOptions& options) {
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
  add_date(app, options.date, "the survey, which vdbmap log then tells");
}

void add_range_options(CLI::App& app, BuildCommandOptions& options, CLI::Option* poses) {
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

void add_ray_options(CLI::App& app, BuildCommandOptions& options, CLI::Option* poses) {
  CLI::Option* trajectory =
      app.add_option("--trajectory", options.rays.trajectory,
                     "Where the surveying vehicle was (TUM, map coordinates, times of the points): the map then knows "
                     "from the rays what is free")
          ->type_name("FILE")
          ->excludes(poses);
  add_number_list(app, "--lever-arm", options.rays.lever_arm, 3, "X,Y,Z",
                  "Of the scanner in the frame of the trajectory [m]")
      ->default_str("0,0,0")
      ->needs(trajectory);
  app.add_flag("--visibility", options.rays.of_scans,
               "With --poses: deskew scans with times, and keep from their rays what is free")
      ->needs(poses);
}

void add_options(CLI::App& app, BuildCommandOptions& options) {
  app.add_option("INPUTS", options.inputs,
                 "Point files, and folders of them: PLY, PCD, LAS, LAZ, KITTI .bin, XYZ/CSV, .pcap")
      ->type_name("PATH")
      ->required();
  CLI::Option* poses = app.add_option("--poses", options.poses,
                                      "A pose for each scan (KITTI or TUM); without, the points are in map coordinates")
                           ->type_name("FILE");
  add_range_options(app, options, poses);
  add_ray_options(app, options, poses);
  add_pose_frame(app, options.pose_frame);
  add_scan_selection(app, options.selection);
  add_map_options(app, options);
  add_class_options(app, options.classes);
  add_read_options(app, options.read);
  add_map_output(app, options.output, /*may_be_city=*/true);
  CLI::Option* output = app.get_option("--output");
  output->required(false);
  add_city_output(app, options.city, output);
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

std::vector<double> chosen_voxel_sizes(const BuildCommandOptions& options) {
  if (options.levels.empty()) return default_voxel_sizes(options.voxel_size.value_or(kDefaultVoxelSize));
  if (options.voxel_size && *options.voxel_size != options.levels.front()) {
    throw std::invalid_argument(
        fmt::format("--voxel-size is {} but --levels begins with {}", *options.voxel_size, options.levels.front()));
  }
  return options.levels;
}

BuildOptions build_options(const BuildCommandOptions& options) {
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

std::optional<RangeLimits> range_of(const BuildCommandOptions& options) {
  if (!options.min_range && !options.max_range) return std::nullopt;
  const RangeLimits range{options.min_range.value_or(0),
                          options.max_range.value_or(std::numeric_limits<double>::infinity())};
  if (range.min < range.max) return range;
  throw std::invalid_argument(fmt::format("--min-range is {} but --max-range {}", range.min, range.max));
}

MapFromFilesOptions files_options(const BuildOptions& build_options, const BuildCommandOptions& command,
                                  const CommonOptions& common) {
  MapFromFilesOptions options;
  options.build = build_options;
  options.inputs.label_scheme = command.classes.scheme();
  options.inputs.dropped_classes = command.classes.dropped;
  options.inputs.read = command.read;
  options.inputs.range = range_of(command);
  options.inputs.reads_ahead = common.num_threads != 1;
  return options;
}

MapFromFiles build(const std::vector<MapInput>& inputs, MapFromFilesOptions options, const CommonOptions& common) {
  Progress progress("building from scans", inputs.size(), common);
  options.inputs.on_scan_done = [&progress] { progress.advance(); };
  return build_map_from_files(inputs, options);
}

std::vector<std::filesystem::path> label_files(const std::vector<MapInput>& inputs) {
  std::vector<std::filesystem::path> files;
  for (const MapInput& input : inputs) {
    if (input.labels) files.push_back(*input.labels);
  }
  return files;
}

ReadingReport complete(ReadingReport reading, const InputNotes& notes, const ChosenInputs& chosen,
                       const BuildCommandOptions& options) {
  reading.add(notes.findings);
  if (chosen.poses) reading.add(*options.poses, chosen.poses->poses.findings);
  reading.warn();
  return reading;
}

void warn_without_labels(const std::string& label_scheme, bool has_labels) {
  if (!label_scheme.empty() && !has_labels) {
    spdlog::warn("--label-scheme {}: the files hold no labels", label_scheme);
  }
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The places of the scans in their sequence, rays and all.
MapExtras extras_of_survey(const VoxelMap& map, const ChosenInputs& chosen, const InputOptions& inputs,
                           const RayOptions& rays, const CommonOptions& common) {
  const Eigen::Vector3d lever_arm =
      rays.lever_arm.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(rays.lever_arm.data());
  Progress progress("following rays", chosen.inputs.size(), common);
  InputOptions options = inputs;
  options.on_scan_done = [&progress] { progress.advance(); };
  SurveyRays survey(chosen.inputs, options, read_survey_track(*rays.trajectory, lever_arm));
  MapExtras extras;
  extras.visibility = find_visibility(map, [&](const auto& take) { survey.for_each(take); });
  if (survey.num_without_ray() > 0) {
    spdlog::warn("{}: {} of {} points are of times without a pose and have no ray", rays.trajectory->string(),
                 survey.num_without_ray(), survey.num_points());
  }
  return extras;
}

MapHistory history_of(const ChosenInputs& chosen, const BuildCommandOptions& options) {
  MapHistory history;
  const std::int32_t epoch = options.epoch.value_or(0);
  history.epochs.push_back({epoch, options.date, {}});
  history.sources = identify_sources(chosen.inputs);
  for (MapSource& source : history.sources) source.epoch = epoch;
  return history;
}

// Scans with poses: deskewed, as localize means their poses.
MapFromFiles build_of_drive(PosedDrive& drive, const MapFromFilesOptions& files, const ChosenInputs& chosen) {
  MapBuilder builder(files.build);
  drive.for_each([&](const PosedCloud& posed) { builder.add(posed.cloud, posed.map_from_cloud); });
  MapFromFiles built{builder.finish(), {}};
  built.map.label_scheme = drive.label_scheme();
  built.notes.num_points = num_points(built.map.finest());
  built.notes.num_out_of_range = drive.num_out_of_range();
  built.notes.num_of_dropped_classes = drive.num_of_dropped_classes();
  if (built.notes.num_points == 0) {
    throw IoError::malformed(chosen.inputs.front().scan.file, "and the other scans hold no point within the range");
  }
  return built;
}

void run_with_rays_of_scans(const ChosenInputs& chosen, const std::vector<ScanPlace>& all,
                            const MapFromFilesOptions& files, const ReadingReport& listed,
                            const BuildCommandOptions& options, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  Progress progress("building from scans, then following rays", 2 * chosen.inputs.size(), common);
  PosedDrive drive(chosen.inputs, all,
                   {options.read, files.inputs.range, options.classes, true, [&progress] { progress.advance(); }});
  const MapFromFiles built = build_of_drive(drive, files, chosen);
  const MapExtras extras{find_visibility(built.map, [&](const auto& take) { drive.for_each(take); }),
                         history_of(chosen, options)};
  drive.reading().warn();
  const ReadingReport reading = complete(listed, built.notes, chosen, options);
  save_map(options.output.file, built.map, extras, options.output.save);
  print_built(built, options.output.file, {built.notes, chosen, reading, seconds_since(start)}, common.json);
}

void run_for_file(const ChosenInputs& chosen, const MapFromFilesOptions& files, const ReadingReport& listed,
                  const BuildCommandOptions& options, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const MapFromFiles built = build(chosen.inputs, files, common);
  warn_of(built.notes, built.map.frame.epsg);
  warn_without_labels(options.classes.scheme_name, !built.map.finest().channels().labels.empty());
  const ReadingReport reading = complete(listed, built.notes, chosen, options);
  MapExtras extras;
  if (options.rays.trajectory) extras = extras_of_survey(built.map, chosen, files.inputs, options.rays, common);
  if (options.rays.trajectory || !options.date.empty()) extras.history = history_of(chosen, options);
  save_map(options.output.file, built.map, extras, options.output.save);
  print_built(built, options.output.file, {built.notes, chosen, reading, seconds_since(start)}, common.json);
}

void run_for_city(const ChosenInputs& chosen, const MapFromFilesOptions& files, const ReadingReport& listed,
                  const BuildCommandOptions& options, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const CityBuilt built =
      build_city_of(chosen.inputs, files, options.output.save, options.output.file, options.city, common);
  const CityLayout& layout = built.manifest.layout;
  warn_of(built.notes, layout.frame.epsg);
  warn_without_labels(options.classes.scheme_name, std::ranges::count(layout.channels, "label") > 0);
  warn_not_counted(built);
  const ReadingReport reading = complete(listed, built.notes, chosen, options);
  const std::filesystem::path folder = options.city.into ? *options.city.into : options.output.file;
  print_built(built, folder, {built.notes, chosen, reading, seconds_since(start)}, common.json);
}

// Before the work: whether there is one output, which can be written and is no input.
void check_outputs(const BuildCommandOptions& options, const std::vector<std::filesystem::path>& inputs) {
  if (options.output.file.empty() && !options.city.into) throw std::invalid_argument("--output or --into is required");
  if (options.makes_city()) return;  // its writer checks the folder first of all
  check_output(options.output.file, kMapKind, inputs);
}

// A city keeps its levels where the command says nothing of them; its anchor and its density cannot be others.
BuildOptions checked_build_options(const BuildCommandOptions& options) {
  BuildOptions build = build_options(options);
  if (!options.city.into) return build;
  if (!options.anchor.empty())
    throw std::invalid_argument("--anchor cannot be given with --into: a city keeps its own");
  const City city = open_city(city_folder(*options.city.into));
  const float density = options.output.save.density;
  if (density != SaveOptions().density && density != city.manifest.layout.density) {
    throw std::invalid_argument(
        fmt::format("--density is {}, but the city has {}", density, city.manifest.layout.density));
  }
  if (!options.voxel_size && options.levels.empty()) build.voxel_sizes = city.manifest.layout.voxel_sizes;
  return build;
}

ExitCode run(const BuildCommandOptions& options, const CommonOptions& common) {
  const BuildOptions build_options = checked_build_options(options);
  range_of(options);
  ReadingReport listed;
  const std::vector<std::filesystem::path> files = list_inputs(options.inputs, listed);
  std::vector<std::filesystem::path> read_files = files;
  if (options.poses) read_files.push_back(*options.poses);
  if (options.classes.labels) read_files.push_back(*options.classes.labels);
  if (options.rays.trajectory) read_files.push_back(*options.rays.trajectory);
  check_outputs(options, read_files);
  const std::vector<ScanPlace> all = list_scans(files, options.read);
  ChosenInputs chosen = choose_inputs(all, options.selection, options.poses, options.pose_frame);
  if (options.classes.labels) add_label_files(chosen.inputs, *options.classes.labels);
  check_outputs(options, label_files(chosen.inputs));
  const MapFromFilesOptions input_options = files_options(build_options, options, common);
  if (options.makes_city()) {
    if (options.rays.are_wanted() || !options.date.empty()) {
      throw std::invalid_argument("--trajectory, --visibility and --date are for maps in one file");
    }
    run_for_city(chosen, input_options, listed, options, common);
  } else if (options.rays.of_scans) {
    run_with_rays_of_scans(chosen, all, input_options, listed, options, common);
  } else {
    run_for_file(chosen, input_options, listed, options, common);
  }
  return ExitCode::kDone;
}

}  // namespace

Command build_command() {
  return make_command<BuildCommandOptions>(
      "build", "Make a map of point clouds, or of scans with a pose each",
      "vdbmap build street.las -o map.vdb\n"
      "vdbmap build velodyne/ --poses poses.txt --every 2 -o map.vdb\n"
      "vdbmap build sequences/00/velodyne --poses poses.txt --labels sequences/00/labels -o map.vdb\n"
      "vdbmap build survey.laz --trajectory mapper.tum --date 2023-03-02 -o map.vdb\n"
      "vdbmap build a.ply b.ply --levels 0.05,0.5 --epsg 25832 --epoch 3 -o map.vdb\n"
      "vdbmap build survey/ -o city/ --epoch 1 --memory 1G\n"
      "vdbmap build more/ --into city/ --epoch 2",
      add_options, run);
}

}  // namespace vdbmap::cli
