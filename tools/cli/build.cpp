// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/build_city.h"
#include "tools/cli/build_options.h"
#include "tools/cli/build_report.h"
#include "tools/cli/city_output.h"
#include "tools/cli/command.h"
#include "tools/cli/date_option.h"
#include "tools/cli/map_output.h"
#include "tools/cli/number_list.h"
#include "tools/cli/posed_drive.h"
#include "tools/cli/progress.h"
#include "tools/cli/reading.h"
#include "tools/cli/survey_rays.h"
#include "vdbmap/change/map_visibility.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/store/source_hash.h"

namespace vdbmap::cli {
namespace {

// What is said of the rays by which the points were measured.
struct RayOptions {
  std::optional<std::filesystem::path> trajectory;
  std::vector<double> lever_arm;
  bool of_scans = false;  // whose poses are given
};

struct BuildCommandOptions {
  MapBuildOptions points;
  std::string date;
  RayOptions rays;
  MapOutput output;
  CityOutput city;

  bool makes_city() const { return city.into || is_city_output(output.file); }
  bool changes_sources() const { return !city.removed.empty() || !city.replaced.empty(); }
};

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
               "With --poses, for a map in one file: deskew scans with times, and keep from their rays what is free")
      ->needs(poses);
}

void add_options(CLI::App& app, BuildCommandOptions& options) {
  CLI::Option* poses = add_map_build_options(app, options.points);
  add_date(app, options.date, "the survey, which vdbmap log then tells");
  add_ray_options(app, options, poses);
  add_map_output(app, options.output, /*may_be_city=*/true);
  CLI::Option* output = app.get_option("--output");
  output->required(false);
  add_city_output(app, options.city, output);
  app.get_option("INPUTS")->required(false);  // where sources are removed or replaced
}

MapFromFiles build(const std::vector<MapInput>& inputs, MapFromFilesOptions options, const CommonOptions& common) {
  Progress progress("building from scans", inputs.size(), common);
  options.inputs.on_scan_done = [&progress] { progress.advance(); };
  return build_map_from_files(inputs, options);
}

ReadingReport complete(ReadingReport reading, const InputNotes& notes, const ChosenInputs& chosen,
                       const BuildCommandOptions& options) {
  reading.add(notes.findings);
  if (chosen.poses) reading.add(*options.points.poses, chosen.poses->poses.findings);
  reading.warn();
  return reading;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

SurveyTrack track_of(const RayOptions& rays) {
  const Eigen::Vector3d lever_arm =
      rays.lever_arm.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(rays.lever_arm.data());
  return read_survey_track(*rays.trajectory, lever_arm);
}

// The places of the scans in their sequence, rays and all.
MapExtras extras_of_survey(const VoxelMap& map, const ChosenInputs& chosen, const InputOptions& inputs,
                           const RayOptions& rays, const CommonOptions& common) {
  Progress progress("following rays", chosen.inputs.size(), common);
  InputOptions options = inputs;
  options.on_scan_done = [&progress] { progress.advance(); };
  SurveyRays survey(chosen.inputs, options, track_of(rays));
  MapExtras extras;
  extras.visibility = find_visibility(map, [&](const auto& take) { survey.for_each(take); });
  survey.warn();
  return extras;
}

MapHistory history_of(const ChosenInputs& chosen, const BuildCommandOptions& options) {
  MapHistory history;
  const std::int32_t epoch = options.points.epoch.value_or(0);
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
  PosedDrive drive(
      chosen.inputs, all,
      {options.points.read, files.inputs.range, options.points.classes, true, [&progress] { progress.advance(); }});
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
  warn_without_labels(options.points.classes.scheme_name, !built.map.finest().channels().labels.empty());
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
  std::vector<SourceReplacement> replaced;
  for (const std::string& text : options.city.replaced) {
    replaced.push_back(parse_replacement(text, options.points.read));
  }
  CitySurvey survey{options.date, {}};
  if (options.rays.trajectory) survey.track = track_of(options.rays);
  const CityBuilt built = build_city_of(chosen.inputs, replaced, files, options.output.save, survey,
                                        options.output.file, options.city, common);
  const CityLayout& layout = built.manifest.layout;
  warn_of(built.notes, layout.frame.epsg);
  warn_without_labels(options.points.classes.scheme_name, std::ranges::count(layout.channels, "label") > 0);
  warn_not_counted(built);
  const ReadingReport reading = complete(listed, built.notes, chosen, options);
  const std::filesystem::path folder = options.city.into ? *options.city.into : options.output.file;
  print_built(built, folder, {built.notes, chosen, reading, seconds_since(start)}, common.json);
}

// Before the work: whether there is one output, which can be written and is no input.
void check_outputs(const BuildCommandOptions& options, const std::vector<std::filesystem::path>& inputs) {
  if (options.output.file.empty() && !options.city.into) throw std::invalid_argument("--output or --into is required");
  if (options.city.keeps_parts && !options.makes_city()) {
    throw std::invalid_argument("--keep-parts is for a city: -o FOLDER/");
  }
  if (options.makes_city() && options.rays.of_scans) {
    throw std::invalid_argument("--visibility is for maps in one file: bring a city up to date by vdbmap update");
  }
  if (options.makes_city()) return;  // its writer checks the folder first of all
  check_output(options.output.file, kMapKind, inputs);
}

std::vector<std::filesystem::path> label_files(const std::vector<MapInput>& inputs) {
  std::vector<std::filesystem::path> files;
  for (const MapInput& input : inputs) {
    if (input.labels) files.push_back(*input.labels);
  }
  return files;
}

ExitCode run(const BuildCommandOptions& options, const CommonOptions& common) {
  const MapBuildOptions& points = options.points;
  if (points.inputs.empty() && !options.changes_sources()) throw std::invalid_argument("INPUTS is required");
  const std::optional<std::filesystem::path>& into = options.city.into;
  const BuildOptions build =
      into ? build_options_into(city_folder(*into), points, options.output.save.density) : build_options(points);
  const MapFromFilesOptions input_options = files_options(build, points, common);
  ReadingReport listed;
  const std::vector<std::filesystem::path> files = list_inputs(points.inputs, listed);
  std::vector<std::filesystem::path> read_files = named_files(points);
  read_files.insert(read_files.end(), files.begin(), files.end());
  if (options.rays.trajectory) read_files.push_back(*options.rays.trajectory);
  check_outputs(options, read_files);
  std::vector<ScanPlace> all;
  ChosenInputs chosen;
  if (!points.inputs.empty()) {
    all = list_scans(files, points.read);
    chosen = chosen_inputs(all, points);
  }
  check_outputs(options, label_files(chosen.inputs));
  if (options.makes_city()) {
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
      "vdbmap build survey/ --trajectory mapper.tum --date 2023-03-02 -o city/ --epoch 1\n"
      "vdbmap build more/ --into city/ --epoch 2\n"
      "vdbmap build survey/ -o city/ --keep-parts\n"
      "vdbmap build --into city/ --replace a.laz=corrected/a.laz --remove b.laz",
      add_options, run);
}

}  // namespace vdbmap::cli
