// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "registration/localizer.h"
#include "tools/cli/command.h"
#include "tools/cli/localize_modes.h"
#include "tools/cli/localize_report.h"
#include "tools/cli/map_output.h"
#include "tools/cli/number_list.h"
#include "tools/cli/output.h"
#include "tools/cli/pose_frame.h"
#include "tools/cli/reading.h"
#include "tools/cli/scan_selection.h"
#include "tools/cli/search_area.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

struct LocalizeCommandOptions {
  std::filesystem::path map;
  std::vector<std::filesystem::path> scans;
  std::optional<std::filesystem::path> initial;
  std::optional<std::filesystem::path> odometry;
  std::vector<double> near;
  std::filesystem::path output;
  std::optional<std::filesystem::path> report;
  std::string format = "kitti";
  PoseFrame pose_frame = PoseFrame::kUnknown;
  ScanSelection selection;
  registration::LocalizerOptions localizer;
  ReadOptions read{.is_in_sensor_frame = true};
};

void add_search_options(CLI::App& app, LocalizeCommandOptions& options, CLI::Option* initial) {
  app.add_option(
         "--odometry", options.odometry,
         "Poses of the chosen scans relative to each other (KITTI or TUM), as of vdbmap odometry; default: made "
         "on the way")
      ->type_name("FILE")
      ->excludes(initial);
  app.add_option("--batch", options.localizer.batch_size,
                 "Scans that are combined and looked for in the whole map together, [20]")
      ->check(CLI::Range(1, 10000).description(""))
      ->type_name("N")
      ->excludes(initial);
  add_number_list(app, "--near", options.near, 3, "X,Y,RADIUS",
                  "Of a city, look only around this place [m]: tiles out of the scans' reach are not opened")
      ->excludes(initial);
  app.add_flag("--upright", options.localizer.upright, "Roll and pitch of the scans are within 10 degrees of the map's")
      ->excludes(initial);
}

void add_options(CLI::App& app, LocalizeCommandOptions& options) {
  app.add_option("MAP", options.map, "The map (.vdb), or a city")->type_name("FILE")->required();
  app.add_option("SCANS", options.scans,
                 "Scans in the frame of the sensor, in order, and folders of them; of a Velodyne capture each turn is "
                 "one")
      ->type_name("PATH...")
      ->required();
  CLI::Option* initial =
      app.add_option(
             "--initial", options.initial,
             "First guesses (KITTI or TUM), up to 2 m and 10 degrees off: one for each chosen scan, or a single "
             "one for the first, from which the motion is followed; without it the whole map is searched")
          ->type_name("FILE");
  add_search_options(app, options, initial);
  app.add_option("-o,--output", options.output, "Where to write the poses")->type_name("FILE")->required();
  app.add_option("--format", options.format, "Of the poses written: kitti or tum, [kitti]")
      ->check(CLI::IsMember({"kitti", "tum"}).description(""))
      ->type_name("NAME");
  app.add_option("--report", options.report,
                 "Write everything known of scans and batches to this JSON file: poses, covariances, evidence, reasons")
      ->type_name("FILE");
  app.add_option("--min-inliers", options.localizer.found.min_inlier_share,
                 "Share of the points that must lie on the map for a scan to count as found, [0.3]")
      ->check(CLI::Range(0.0, 1.0).description(""))
      ->type_name("SHARE");
  add_pose_frame(app, options.pose_frame);
  add_read_options(app, options.read);
  add_scan_selection(app, options.selection);
}

// Poses of odometry, one for every scan, or guesses, which may be a single one for the first.
ScanPoses read_given(const std::filesystem::path& path, const std::vector<ScanPlace>& scans,
                     const LocalizeCommandOptions& options) {
  ScanPoses given = read_scan_poses(path, scans, options.pose_frame);
  Trajectory& poses = given.poses;
  const bool is_single_guess = options.initial && poses.size() == 1;
  if (is_single_guess && !poses.map_from_scan.front()) throw IoError::malformed(path, "its only guess is missing");
  if (!is_single_guess) poses = selected_poses(poses, path, options.selection, scans.size());
  return given;
}

void check_outputs(const LocalizeCommandOptions& options, const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> inputs = files;
  inputs.push_back(options.map);
  if (options.initial) inputs.push_back(*options.initial);
  if (options.odometry) inputs.push_back(*options.odometry);
  check_output(options.output, kPosesKind, inputs);
  if (!options.report) return;
  inputs.push_back(options.output);
  check_output(*options.report, kJsonKind, inputs);
}

std::vector<ScanPlace> choose_scans(const std::vector<std::filesystem::path>& files, const ScanSelection& selection,
                                    const ReadOptions& read) {
  const std::vector<ScanPlace> all = list_scans(files, read);
  std::vector<ScanPlace> chosen = select(all, selection);
  if (!chosen.empty()) return chosen;
  throw std::invalid_argument(fmt::format("{} chooses none of {} scans", selection.text(), all.size()));
}

LocalizeReport localize(const std::vector<ScanPlace>& scans, const LocalizeCommandOptions& options,
                        const CommonOptions& common) {
  const std::optional<std::filesystem::path>& file = options.initial ? options.initial : options.odometry;
  std::optional<ScanPoses> given;
  if (file) given = read_given(*file, scans, options);
  if (!options.near.empty() && !is_city(options.map)) throw std::invalid_argument("--near needs a city, not a file");
  const SearchArea area{options.near, options.initial ? std::optional(given->poses) : std::nullopt,
                        options.localizer.fine.range.max};
  const MapWindows map = open_search_area(options.map, area);
  const std::string reason = options.initial ? "" : registration::reason_not_searchable(map);
  if (!reason.empty()) throw IoError::malformed(options.map, reason);
  const ChosenScans chosen{scans, options.selection.every - 1};
  const std::optional<Trajectory> poses = given ? std::optional(given->poses) : std::nullopt;
  LocalizeReport report = options.initial
                              ? localize_from_guesses(chosen, map, *poses, options.localizer.fine,
                                                      options.localizer.found, options.read, common)
                              : localize_without_guess(chosen, map, poses, options.localizer, options.read, common);
  if (file) report.reading.add(*file, poses->findings);
  report.given = std::move(given);
  return report;
}

ExitCode run(const LocalizeCommandOptions& options, const CommonOptions& common) {
  ReadingReport listing;
  const std::vector<std::filesystem::path> files = list_inputs(options.scans, listing);
  check_outputs(options, files);
  const LocalizeReport report = localize(choose_scans(files, options.selection, options.read), options, common);
  listing.warn();
  warn(report);

  const auto format = options.format == "tum" ? TrajectoryFormat::kTum : TrajectoryFormat::kKitti;
  write_trajectory(options.output, report.trajectory(), format);
  if (options.report) write_json(*options.report, json_of(report, options.output));
  if (common.json) {
    print_json(json_of(report, options.output));
  } else {
    print_result(
        fmt::format("{}: {} of {} scans found\n", options.output.string(), report.num_found(), report.scans.size()));
  }
  return report.num_found() > 0 ? ExitCode::kDone : ExitCode::kNo;
}

}  // namespace

Command localize_command() {
  return make_command<LocalizeCommandOptions>(
      "localize", "Find scans in a map, with no first guess or from one",
      "vdbmap localize map.vdb velodyne/ -o poses.txt --report report.json\n"
      "vdbmap localize map.vdb velodyne/ --odometry odometry.txt --batch 40 -o poses.txt\n"
      "vdbmap localize map.vdb velodyne/ --every 2 --offset 1 --initial guesses.txt -o poses.txt --json\n"
      "vdbmap localize city/ velodyne/ --near 552158,5802631,150 -o poses.txt\n"
      "vdbmap localize map.vdb scan.pcd --initial guess.txt --format tum -o pose.tum",
      add_options, run);
}

}  // namespace vdbmap::cli
