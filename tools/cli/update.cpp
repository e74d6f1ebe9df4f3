// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

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
};

void add_options(CLI::App& app, UpdateCommandOptions& options) {
  app.add_option("MAP", options.map, "The map to bring up to date (.vdb)")->type_name("FILE")->required();
  app.add_option("SCANS", options.scans,
                 "Scans in the frame of the sensor, in order, and folders of them; of a Velodyne capture each turn is "
                 "one")
      ->type_name("PATH...")
      ->required();
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
  add_map_output(app, options.output);
}

// What is counted already is left out; one that is here twice too.
std::vector<MapInput> new_inputs(const std::vector<MapInput>& inputs, const std::vector<MapSource>& sources,
                                 const MapHistory& history, std::vector<MapSource>& added) {
  std::set<std::string> seen;
  std::vector<MapInput> fresh;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (history.has_source(sources[i].hash) || !seen.insert(sources[i].hash).second) continue;
    fresh.push_back(inputs[i]);
    added.push_back(sources[i]);
  }
  return fresh;
}

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

// Of an epoch that goes on, changes add up.
void add_epoch(MapHistory& history, const MapEpoch& epoch) {
  const bool goes_on = !history.epochs.empty() && history.epochs.back().number == epoch.number;
  if (!goes_on) return history.epochs.push_back(epoch);
  MapEpoch& last = history.epochs.back();
  if (!epoch.date.empty()) last.date = epoch.date;
  last.changes = last.changes + epoch.changes;
}

MapChanges changes_of(const UpdateCounts& counts) {
  return {counts.added, counts.confirmed, counts.replaced, counts.gone, counts.unseen, counts.moved};
}

// What became of the scans.
struct ScanCounts {
  std::size_t used = 0;
  std::size_t counted_before = 0;
  std::size_t uncertain = 0;
  std::size_t damaged = 0;
};

nlohmann::ordered_json json_of(const UpdateCounts& counts) {
  return {{"added", counts.added},       {"confirmed", counts.confirmed},
          {"replaced", counts.replaced}, {"gone", counts.gone},
          {"unseen", counts.unseen},     {"moved", counts.moved},
          {"points", counts.num_points}, {"moved_points", counts.num_moved_points}};
}

void report(const UpdatedMap& updated, const UpdateCommandOptions& options, const MapEpoch& epoch,
            const ScanCounts& scans, const PosedDrive& drive, double seconds, bool as_json) {
  const UpdateCounts& counts = updated.counts;
  if (as_json) {
    print_json({{"output", options.output.file.string()},
                {"epoch", epoch.number},
                {"date", epoch.date.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(epoch.date)},
                {"scans", scans.used},
                {"scans_counted_before", scans.counted_before},
                {"scans_too_uncertain", scans.uncertain},
                {"scans_damaged", scans.damaged},
                {"points_out_of_range", drive.num_out_of_range()},
                {"points_of_dropped_classes", drive.num_of_dropped_classes()},
                {"voxels", json_of(counts)},
                {"findings", drive.reading().json()},
                {"seconds", seconds}});
    return;
  }
  std::string text = fmt::format("{}: epoch {}{}, {} scans in {:.1f} s\n", options.output.file.string(), epoch.number,
                                 epoch.date.empty() ? "" : " (" + epoch.date + ")", scans.used, seconds);
  if (scans.counted_before > 0)
    text += fmt::format("skipped    {} scans that were counted before\n", scans.counted_before);
  if (scans.uncertain > 0)
    text += fmt::format("left out   {} scans whose place is less certain than a voxel\n", scans.uncertain);
  if (scans.damaged > 0) text += fmt::format("left out   {} damaged scans\n", scans.damaged);
  if (drive.num_of_dropped_classes() > 0)
    text += fmt::format("dropped    {} points of the classes not wanted\n", drive.num_of_dropped_classes());
  text += fmt::format(
      "added      {:9} voxels\ngone       {:9} seen through\nreplaced   {:9} something else is there\n"
      "confirmed  {:9} seen again\nunseen     {:9} nobody looked\nmoved      {:9} left out, {} points\n",
      counts.added, counts.gone, counts.replaced, counts.confirmed, counts.unseen, counts.moved,
      counts.num_moved_points);
  print_result(text);
}

void drop_uncertain(std::vector<MapInput>& inputs, const UpdateCommandOptions& options, double voxel_size,
                    ScanCounts& counts) {
  if (!options.report) return;
  const PoseCertainty certainty = read_pose_certainty(*options.report);
  counts.uncertain = std::erase_if(inputs, [&](const MapInput& input) {
    const std::optional<double> sigma = certainty.position_sigma(input.scan);
    return sigma && *sigma > voxel_size;
  });
}

// Tiles keep no rays yet.
void refuse_cities(const UpdateCommandOptions& options) {
  for (const std::filesystem::path& path : {options.map, options.output.file}) {
    if (is_city_output(path)) {
      throw std::invalid_argument(path.string() + ": is a city, update takes and makes maps in one file");
    }
  }
}

ExitCode run(const UpdateCommandOptions& options, const CommonOptions& common) {
  refuse_cities(options);
  if (!(options.min_range < options.max_range)) {
    throw std::invalid_argument(
        fmt::format("--min-range is {} but --max-range {}", options.min_range, options.max_range));
  }
  ReadingReport listed;
  const std::vector<std::filesystem::path> files = list_inputs(options.scans, listed);
  std::vector<std::filesystem::path> read_files = files;
  read_files.push_back(options.poses);
  check_output(options.output.file, kMapKind, read_files);
  const auto start = std::chrono::steady_clock::now();
  const VoxelMap map = load_map(options.map);
  std::optional<Visibility> before = load_visibility(options.map, map);
  MapHistory history = load_history(options.map);
  const std::vector<ScanPlace> all = list_scans(files, options.read);
  ChosenInputs chosen = choose_inputs(all, options.selection, options.poses, options.pose_frame);
  if (options.classes.labels) add_label_files(chosen.inputs, *options.classes.labels);
  listed.warn();
  ScanCounts scans;
  drop_uncertain(chosen.inputs, options, map.finest().voxel_size(), scans);

  std::vector<MapSource> added;
  const std::vector<MapInput> inputs = new_inputs(chosen.inputs, identify_sources(chosen.inputs), history, added);
  scans.counted_before = chosen.inputs.size() - inputs.size();
  if (inputs.empty()) {
    throw std::invalid_argument(scans.uncertain > 0 && chosen.inputs.empty()
                                    ? "no scan's place is as certain as a voxel"
                                    : "all of the scans were counted in " + options.map.string() + " before");
  }
  MapEpoch epoch{chosen_epoch(options, map, history), options.date, {}};
  UpdateOptions update;
  update.epoch = epoch.number;
  Progress progress("updating from scans", 2 * inputs.size(), common);
  PosedDrive drive(inputs, all,
                   {options.read, RangeLimits{options.min_range, options.max_range}, options.classes,
                    !options.has_moved_points, [&progress] { progress.advance(); }});
  UpdatedMap updated = update_map(
      map, before, [&](const auto& take) { drive.for_each(take); }, update);
  drive.reading().warn();
  if (updated.counts.confirmed + updated.counts.replaced + updated.counts.gone == 0 && map.finest().size() > 0) {
    throw IoError::malformed(options.poses, "the scans do not meet the map " + options.map.string() +
                                                " anywhere: no voxel of it was seen again or through");
  }
  if (drive.has_labels() && drive.label_scheme() != map.label_scheme && map.label_scheme != LabelScheme::kUnknown) {
    throw IoError::malformed(inputs.front().scan.file,
                             "has, or scans after it have, classes of " + std::string(text_of(drive.label_scheme())) +
                                 ", the map " + options.map.string() + " of " + std::string(text_of(map.label_scheme)));
  }
  if (map.label_scheme == LabelScheme::kUnknown) updated.map.label_scheme = drive.label_scheme();
  scans.damaged = drive.num_damaged();
  scans.used = inputs.size() - scans.damaged;
  for (MapSource& source : added) source.epoch = epoch.number;
  history.sources.insert(history.sources.end(), added.begin(), added.end());
  epoch.changes = changes_of(updated.counts);
  add_epoch(history, epoch);
  save_map(options.output.file, updated.map, {updated.visibility, history}, options.output.save);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report(updated, options, epoch, scans, drive, seconds, common.json);
  return ExitCode::kDone;
}

}  // namespace

Command update_command() {
  return make_command<UpdateCommandOptions>(
      "update", "Bring a map up to date from localized scans",
      "vdbmap update map.vdb drive/ --poses poses.txt -o map2.vdb\n"
      "vdbmap update map.vdb drive/ --poses poses.txt --localized report.json --epoch 2 --date 2023-09-14 -o map2.vdb",
      add_options, run);
}

}  // namespace vdbmap::cli
