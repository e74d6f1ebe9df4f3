// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/Option.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/build_inputs.h"
#include "tools/cli/city_output.h"
#include "tools/cli/class_options.h"
#include "tools/cli/command.h"
#include "tools/cli/date_option.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/pose_certainty.h"
#include "tools/cli/pose_frame.h"
#include "tools/cli/posed_drive.h"
#include "tools/cli/progress.h"
#include "tools/cli/reading.h"
#include "tools/cli/scan_selection.h"
#include "vdbmap/change/map_update.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/store/city_update.h"
#include "vdbmap/store/source_hash.h"

namespace vdbmap::cli {
namespace {

struct UpdateCommandOptions {
  std::filesystem::path map;
  std::vector<std::filesystem::path> scans;
  std::filesystem::path poses;
  std::optional<std::filesystem::path> report;  // of localize
  PoseFrame pose_frame = PoseFrame::kUnknown;
  ScanSelection selection;
  std::optional<std::int32_t> epoch;
  std::string date;
  double min_range = 0;  // [m]
  double max_range = std::numeric_limits<double>::infinity();
  bool has_moved_points = false;
  ClassOptions classes;
  ReadOptions read;
  MapOutput output;
  CityOutput city;

  // The city that is changed or made, else the file.
  std::filesystem::path result() const { return city.into ? city_folder(*city.into) : output.file; }
};

void add_options(CLI::App& app, UpdateCommandOptions& options) {
  app.add_option("MAP", options.map, "The map to bring up to date (.vdb), or a city; left out with --into")
      ->type_name("FILE|FOLDER")
      ->required();
  app.add_option("SCANS", options.scans,
                 "Scans in the frame of the sensor, in order, and folders of them; of a Velodyne capture each turn is "
                 "one")
      ->type_name("PATH...");
  app.add_option("--poses", options.poses, "A pose for each scan (KITTI or TUM), as vdbmap localize writes them")
      ->type_name("FILE")
      ->required();
  app.add_option("--localized", options.report,
                 "The report of vdbmap localize: scans whose place is less certain than a voxel are left out")
      ->type_name("FILE");
  add_pose_frame(app, options.pose_frame);
  add_scan_selection(app, options.selection);
  app.add_option("--epoch", options.epoch, "Number of the drive (default: one more than the map's latest)")
      ->check(CLI::Range(0, std::numeric_limits<std::int32_t>::max()).description(""))
      ->type_name("N");
  add_date(app, options.date, "the drive");
  app.add_option("--min-range", options.min_range,
                 "Leave out points nearer to the sensor [m], its carrier's for example")
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("R");
  app.add_option("--max-range", options.max_range, "Leave out points farther from the sensor [m]")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->type_name("R");
  app.add_flag("--no-deskew", options.has_moved_points,
               "The points of scans with times were moved to one time already");
  add_class_options(app, options.classes);
  add_read_options(app, options.read);
  add_map_output(app, options.output, /*may_be_city=*/true);
  CLI::Option* output = app.get_option("--output");
  output->required(false);
  add_city_addition(app, options.city, output);
  app.get_option("--into")->description("Bring this city up to date; scans that it has counted already are left out");
  add_memory(app, options.city.memory_bytes,
             "What the update of a city may take, as 500M or 2G: the drive is looked at in windows of its tiles, [2G]");
}

// The scans that are new, and what became of the others.
struct NewScans {
  ReadingReport listed;
  std::vector<ScanPlace> all;  // of the sequence
  std::vector<MapInput> inputs;
  std::vector<MapSource> sources;  // of the inputs
  std::size_t num_counted_before = 0;
  std::size_t num_uncertain = 0;
};

std::int32_t last_epoch(const VoxelMap& map, const MapHistory& history) {
  std::int32_t last = history.epochs.empty() ? 0 : history.epochs.back().number;
  for (const std::int32_t epoch : map.finest().channels().last_epochs) last = std::max(last, epoch);
  return last;
}

std::int32_t chosen_epoch(const UpdateCommandOptions& options, const VoxelMap& map, const MapHistory& history) {
  const std::int32_t last = last_epoch(map, history);
  if (!options.epoch) return last + 1;
  if (*options.epoch >= last) return *options.epoch;
  throw std::invalid_argument(fmt::format("--epoch is {}, but the map is of epoch {}", *options.epoch, last));
}

nlohmann::ordered_json json_of(const UpdateCounts& counts) {
  return {{"added", counts.added},       {"confirmed", counts.confirmed},
          {"replaced", counts.replaced}, {"gone", counts.gone},
          {"unseen", counts.unseen},     {"moved", counts.moved},
          {"points", counts.num_points}, {"moved_points", counts.num_moved_points}};
}

// What was done, to be told.
struct Outcome {
  std::int32_t epoch;
  UpdateCounts counts;
  std::optional<std::size_t> num_tiles;  // of a city, made anew
  double seconds = 0;
};

std::string tiles_text(const Outcome& outcome) {
  return outcome.num_tiles ? fmt::format("tiles      {:9} made anew\n", *outcome.num_tiles) : "";
}

void report(const Outcome& outcome, const UpdateCommandOptions& options, const NewScans& scans, const PosedDrive& drive,
            bool as_json) {
  const UpdateCounts& counts = outcome.counts;
  const std::size_t num_used = scans.inputs.size() - drive.num_damaged();
  if (as_json) {
    nlohmann::ordered_json json = {
        {"output", options.result().string()},
        {"epoch", outcome.epoch},
        {"date", options.date.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(options.date)},
        {"scans", num_used},
        {"scans_counted_before", scans.num_counted_before},
        {"scans_too_uncertain", scans.num_uncertain},
        {"scans_damaged", drive.num_damaged()},
        {"points_out_of_range", drive.num_out_of_range()},
        {"points_of_dropped_classes", drive.num_of_dropped_classes()},
        {"voxels", json_of(counts)},
        {"findings", drive.reading().json()},
        {"seconds", outcome.seconds}};
    if (outcome.num_tiles) json["tiles"] = *outcome.num_tiles;
    print_json(json);
    return;
  }
  std::string text = fmt::format("{}: epoch {}{}, {} scans in {:.1f} s\n", options.result().string(), outcome.epoch,
                                 options.date.empty() ? "" : " (" + options.date + ")", num_used, outcome.seconds);
  if (scans.num_counted_before > 0)
    text += fmt::format("skipped    {} scans that were counted before\n", scans.num_counted_before);
  if (scans.num_uncertain > 0)
    text += fmt::format("left out   {} scans whose place is less certain than a voxel\n", scans.num_uncertain);
  if (drive.num_damaged() > 0) text += fmt::format("left out   {} damaged scans\n", drive.num_damaged());
  if (drive.num_of_dropped_classes() > 0)
    text += fmt::format("dropped    {} points of the classes not wanted\n", drive.num_of_dropped_classes());
  text += fmt::format(
      "added      {:9} voxels\ngone       {:9} seen through\nreplaced   {:9} something else is there\n"
      "confirmed  {:9} seen again\nunseen     {:9} nobody looked\nmoved      {:9} left out, {} points\n",
      counts.added, counts.gone, counts.replaced, counts.confirmed, counts.unseen, counts.moved,
      counts.num_moved_points);
  print_result(text + tiles_text(outcome));
}

std::size_t drop_uncertain(std::vector<MapInput>& inputs, const std::filesystem::path& report, double voxel_size) {
  const PoseCertainty certainty = read_pose_certainty(report);
  return std::erase_if(inputs, [&](const MapInput& input) {
    const std::optional<double> sigma = certainty.position_sigma(input.scan);
    return sigma && *sigma > voxel_size;
  });
}

// Takes out what is counted already, and one that is here twice.
void drop_counted(NewScans& scans, const std::vector<MapInput>& inputs, const std::vector<MapSource>& known) {
  std::set<std::string> seen;
  for (const MapSource& source : known) seen.insert(source.hash);
  const std::vector<MapSource> sources = identify_sources(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!seen.insert(sources[i].hash).second) continue;
    scans.inputs.push_back(inputs[i]);
    scans.sources.push_back(sources[i]);
  }
  scans.num_counted_before = inputs.size() - scans.inputs.size();
}

// The scans for a map of voxels [m] that has counted some sources.
NewScans choose_scans(const UpdateCommandOptions& options, const std::vector<std::filesystem::path>& files,
                      ReadingReport listed, double voxel_size, const std::vector<MapSource>& known) {
  NewScans scans;
  scans.listed = std::move(listed);
  scans.all = list_scans(files, options.read);
  ChosenInputs chosen = choose_inputs(scans.all, options.selection, options.poses, options.pose_frame);
  if (options.classes.labels) add_label_files(chosen.inputs, *options.classes.labels);
  scans.listed.warn();
  if (options.report) scans.num_uncertain = drop_uncertain(chosen.inputs, *options.report, voxel_size);
  drop_counted(scans, chosen.inputs, known);
  if (!scans.inputs.empty()) return scans;
  throw std::invalid_argument(chosen.inputs.empty()
                                  ? "no scan's place is as certain as a voxel"
                                  : "all of the scans were counted in " +
                                        (options.city.into ? *options.city.into : options.map).string() + " before");
}

void check_met(const UpdateCounts& counts, bool has_voxels, const UpdateCommandOptions& options) {
  if (counts.confirmed + counts.replaced + counts.gone > 0 || !has_voxels) return;
  const std::filesystem::path& map = options.city.into ? *options.city.into : options.map;
  throw IoError::malformed(options.poses, "the scans do not meet the map " + map.string() +
                                              " anywhere: no voxel of it was seen again or through");
}

// Whose numbers the labels are afterwards.
LabelScheme scheme_after(const PosedDrive& drive, const NewScans& scans, LabelScheme of_map,
                         const UpdateCommandOptions& options) {
  if (of_map == LabelScheme::kUnknown) return drive.label_scheme();
  if (!drive.has_labels() || drive.label_scheme() == of_map) return of_map;
  const std::filesystem::path& map = options.city.into ? *options.city.into : options.map;
  throw IoError::malformed(scans.inputs.front().scan.file,
                           "has, or scans after it have, classes of " + std::string(text_of(drive.label_scheme())) +
                               ", the map " + map.string() + " of " + std::string(text_of(of_map)));
}

PosedDrive::Options drive_options(const UpdateCommandOptions& options, Progress& progress) {
  return {options.read, RangeLimits{options.min_range, options.max_range}, options.classes, !options.has_moved_points,
          [&progress] { progress.advance(); }};
}

double seconds_from(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void update_file(const UpdateCommandOptions& options, const std::vector<std::filesystem::path>& files,
                 const ReadingReport& listed, const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const VoxelMap map = load_map(options.map);
  const std::optional<Visibility> before = load_visibility(options.map, map);
  MapHistory history = load_history(options.map);
  NewScans scans = choose_scans(options, files, listed, map.finest().voxel_size(), history.sources);
  UpdateOptions update;
  update.epoch = chosen_epoch(options, map, history);
  constexpr std::size_t kTimes = 3;  // that update_map() goes through the clouds
  Progress progress("updating from scans", kTimes * scans.inputs.size(), common);
  PosedDrive drive(scans.inputs, scans.all, drive_options(options, progress));
  UpdatedMap updated = update_map(
      map, before, [&](const auto& take) { drive.for_each(take); }, update);
  drive.reading().warn();
  check_met(updated.counts, map.finest().size() > 0, options);
  updated.map.label_scheme = scheme_after(drive, scans, map.label_scheme, options);
  for (MapSource& source : scans.sources) source.epoch = *update.epoch;
  history.sources.insert(history.sources.end(), scans.sources.begin(), scans.sources.end());
  add_epoch(history.epochs, {*update.epoch, options.date, changes_of(updated.counts)});
  save_map(options.output.file, updated.map, {updated.visibility, history}, options.output.save);
  report({*update.epoch, updated.counts, std::nullopt, seconds_from(start)}, options, scans, drive, common.json);
}

void update_city_of(const std::filesystem::path& folder, const UpdateCommandOptions& options,
                    const std::vector<std::filesystem::path>& files, const ReadingReport& listed,
                    const CommonOptions& common) {
  const auto start = std::chrono::steady_clock::now();
  const CityManifest manifest = open_city(folder).manifest;
  CityUpdateOptions update;
  update.update.epoch = epoch_after(manifest, options.epoch);
  update.date = options.date;
  update.memory_bytes = options.city.memory_bytes;
  if (options.city.keep_epochs) update.keep_epochs = *options.city.keep_epochs;
  const NewScans scans = choose_scans(options, files, listed, manifest.layout.voxel_sizes.front(), manifest.sources);
  constexpr std::size_t kTimes = 2;  // that update_city() goes through the clouds
  Progress progress("updating from scans", kTimes * scans.inputs.size(), common);
  std::optional<Progress> of_tiles;
  PosedDrive drive(scans.inputs, scans.all, drive_options(options, progress));
  update.label_scheme = [&](LabelScheme of_city) { return scheme_after(drive, scans, of_city, options); };
  update.check = [&](const UpdateCounts& counts) { check_met(counts, num_voxels(manifest).front() > 0, options); };
  update.on_tiles_begun = [&](std::size_t count) { of_tiles.emplace("making tiles anew", count, common); };
  update.on_tile_done = [&] { of_tiles->advance(); };
  const UpdatedCity updated = update_city(
      folder, city_folder(options.result()), [&](const auto& take) { drive.for_each(take); }, scans.sources, update);
  of_tiles.reset();
  drive.reading().warn();
  report({updated.manifest.epoch, updated.counts, updated.num_renewed, seconds_from(start)}, options, scans, drive,
         common.json);
}

// With --into there is no map before the scans.
UpdateCommandOptions sorted_out(UpdateCommandOptions options) {
  if (options.city.into) {
    options.scans.insert(options.scans.begin(), options.map);
    options.map.clear();
  } else if (options.output.file.empty()) {
    throw std::invalid_argument("--output or --into is required");
  } else if (options.scans.empty()) {
    throw std::invalid_argument("SCANS is required");
  }
  if (!(options.min_range < options.max_range)) {
    throw std::invalid_argument(
        fmt::format("--min-range is {} but --max-range {}", options.min_range, options.max_range));
  }
  return options;
}

// A city becomes a city, a file a file.
void check_kinds(const UpdateCommandOptions& options) {
  if (options.city.into || is_city(options.map) == is_city_output(options.output.file)) return;
  throw std::invalid_argument(
      is_city(options.map)
          ? options.map.string() + ": is a city, write what comes of it --into it or to another folder, '-o other/'"
          : options.map.string() + ": is no city, write what comes of it to a .vdb file, or make it one by export");
}

ExitCode run(const UpdateCommandOptions& given, const CommonOptions& common) {
  const UpdateCommandOptions options = sorted_out(given);
  check_kinds(options);
  ReadingReport listed;
  const std::vector<std::filesystem::path> files = list_inputs(options.scans, listed);
  if (options.city.into) {
    update_city_of(city_folder(*options.city.into), options, files, listed, common);
  } else if (is_city(options.map)) {
    std::error_code missing;
    if (std::filesystem::equivalent(options.map, options.output.file, missing)) {
      throw std::invalid_argument(options.map.string() + ": is an input too, use --into to change it");
    }
    update_city_of(options.map, options, files, listed, common);
  } else {
    std::vector<std::filesystem::path> read_files = files;
    read_files.push_back(options.poses);
    check_output(options.output.file, kMapKind, read_files);
    update_file(options, files, listed, common);
  }
  return ExitCode::kDone;
}

}  // namespace

Command update_command() {
  return make_command<UpdateCommandOptions>(
      "update", "Bring a map or a city up to date from localized scans",
      "vdbmap update map.vdb drive/ --poses poses.txt -o map2.vdb\n"
      "vdbmap update map.vdb drive/ --poses poses.txt --localized report.json --epoch 2 --date 2023-09-14 -o map2.vdb\n"
      "vdbmap update --into city/ drive/ --poses poses.txt --epoch 2 --memory 1G\n"
      "vdbmap update city/ drive/ --poses poses.txt -o other/",
      add_options, run);
}

}  // namespace vdbmap::cli
