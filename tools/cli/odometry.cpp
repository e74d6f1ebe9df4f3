// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/odometry/odometry.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "registration/odometry/step_trajectory.h"
#include "tools/cli/command.h"
#include "tools/cli/json_text.h"
#include "tools/cli/map_output.h"
#include "tools/cli/odometry_outputs.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/read_scan.h"
#include "tools/cli/scan_selection.h"
#include "tools/cli/stop_request.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap::cli {
namespace {

using registration::OdometryStep;

struct OdometryCommandOptions {
  std::vector<std::filesystem::path> scans;
  OdometryOutputs outputs;
  std::string format = "kitti";
  ScanSelection selection;
  double min_range = registration::OdometryOptions().range.min;
  double max_range = registration::OdometryOptions().range.max;
  bool has_moved_points = false;
  ReadOptions read{.is_in_sensor_frame = true};
};

// What became of one scan.
struct ScanReport {
  ScanPlace scan;
  OdometryStep step;
};

void add_options(CLI::App& app, OdometryCommandOptions& options) {
  app.add_option(
         "SCANS", options.scans,
         "Scans in the frame of the sensor, in order, and folders of them; of a Velodyne capture each turn is one")
      ->type_name("PATH...")
      ->required();
  app.add_option("-o,--output", options.outputs.poses, "Where to write the poses, in the frame of the first scan")
      ->type_name("FILE")
      ->required();
  app.add_option("--combined", options.outputs.combined, "Write all scans as one cloud to this .ply, .las or .xyz file")
      ->type_name("FILE");
  app.add_option("--map", options.outputs.map, "Write a map of all scans, 10 cm and 1 m, to this .vdb file")
      ->type_name("FILE");
  app.add_option("--format", options.format, "Of the poses written: kitti or tum, [kitti]")
      ->check(CLI::IsMember({"kitti", "tum"}).description(""))
      ->type_name("NAME");
  app.add_option("--min-range", options.min_range,
                 "Leave out points nearer to the sensor [m], its carrier's for example")
      ->check(CLI::Range(0.0, 1000.0).description(""))
      ->type_name("R")
      ->capture_default_str();
  app.add_option("--max-range", options.max_range,
                 "Leave out points farther from the sensor [m]; a hundredth of it is the voxel size of the local map")
      ->check(CLI::Range(1.0, 1000.0).description(""))
      ->type_name("R")
      ->capture_default_str();
  app.add_flag("--no-deskew", options.has_moved_points,
               "The points are already moved to where the sensor stood at one time, as KITTI's are");
  add_read_options(app, options.read);
  add_scan_selection(app, options.selection);
}

registration::OdometryOptions odometry_options(const OdometryCommandOptions& options) {
  constexpr double kVoxelsPerRange = 100;  // Vizzo 2023, section III
  registration::OdometryOptions odometry;
  odometry.range = {options.min_range, options.max_range};
  odometry.voxel_size = options.max_range / kVoxelsPerRange;
  odometry.deskews = !options.has_moved_points;
  odometry.check();
  return odometry;
}

OdometryStep step_without_points(std::string reason) {
  OdometryStep step;
  step.reason = std::move(reason);
  return step;
}

void warn(const ScanReport& report) {
  const std::string file = report.scan.name();
  const OdometryStep& step = report.step;
  if (!step.registered()) spdlog::warn("{}: no pose: {}", file, step.reason);
  if (!step.time_problem.empty()) spdlog::warn("{}: not deskewed: {}", file, step.time_problem);
  if (step.registered() && step.was_refound) {
    spdlog::warn("{}: is {:.1f} m from where the motion led to, found by a wider search", file, step.jump);
  }
}

std::vector<ScanReport> follow(const std::vector<ScanPlace>& scans, const OdometryCommandOptions& options,
                               const StopRequest& stop, OdometryCollector& collector, const CommonOptions& common) {
  registration::Odometry odometry(odometry_options(options));
  Progress progress("following scans", scans.size(), common);
  ScanReader reader(options.read);
  ReadingReport reading;
  std::vector<ScanReport> reports;
  for (const ScanPlace& place : scans) {
    if (stop.is_made()) break;
    std::string reason;
    std::optional<PointCloud> scan = read_scan(reader, place, reading, reason);
    reports.push_back({place, scan ? odometry.register_scan(*scan) : step_without_points(reason)});
    warn(reports.back());
    odometry.pass_over(options.selection.every - 1 + (scan ? 0 : 1));
    if (scan) collector.add(std::move(*scan), reports.back().step);
    progress.advance();
  }
  reading.warn();
  return reports;
}

Trajectory trajectory_of(const std::vector<ScanReport>& reports) {
  std::vector<OdometryStep> steps;
  for (const ScanReport& report : reports) steps.push_back(report.step);
  return registration::trajectory_of(steps);
}

void warn_of_missing_times(const Trajectory& trajectory, const std::filesystem::path& file) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
    if (trajectory.map_from_scan[i] && std::isnan(trajectory.times[i])) ++count;
  }
  if (count > 0) spdlog::warn("{}: {} poses of scans without a usable time are left out", file.string(), count);
}

std::size_t count_registered(const std::vector<ScanReport>& reports) {
  return static_cast<std::size_t>(
      std::ranges::count_if(reports, [](const ScanReport& report) { return report.step.registered(); }));
}

double path_length(const std::vector<ScanReport>& reports) {
  double length = 0;
  for (const ScanReport& report : reports) length += report.step.previous_from_scan.translation().norm();
  return length;
}

nlohmann::ordered_json json_of(const ScanReport& report) {
  const OdometryStep& step = report.step;
  nlohmann::ordered_json json = json_of_place(report.scan);
  json["registered"] = step.registered();
  if (!step.registered()) json["reason"] = step.reason;
  if (!step.time_problem.empty()) json["not_deskewed"] = step.time_problem;
  if (step.has_time) json["time_s"] = step.motion.reference_time;
  if (step.registered()) {
    json["first_from_scan"] = json_of_matrix(step.first_from_scan.matrix().topRows<3>().eval());
    json["refound"] = step.was_refound;
  }
  if (step.covariance) {
    json["previous_from_scan"] = json_of_matrix(step.previous_from_scan.matrix().topRows<3>().eval());
    json["covariance"] = json_of_matrix(*step.covariance);
  }
  json["overlap_share"] = step.overlap_share;
  json["sigma_m"] = step.sigma;
  json["points"] = step.num_points;
  json["iterations"] = step.num_iterations;
  return json;
}

void print(const std::vector<ScanReport>& reports, std::size_t num_scans, const OdometryCommandOptions& options,
           bool as_json) {
  const std::string file = options.outputs.poses.string();
  const std::size_t num_registered = count_registered(reports);
  if (!as_json) {
    return print_result(
        fmt::format("{}: {} of {} scans, {:.1f} m\n", file, num_registered, num_scans, path_length(reports)));
  }
  nlohmann::ordered_json json = {{"file", file},
                                 {"scans", num_scans},
                                 {"read", reports.size()},
                                 {"registered", num_registered},
                                 {"length_m", path_length(reports)}};
  json["results"] = nlohmann::ordered_json::array();
  for (const ScanReport& report : reports) json["results"].push_back(json_of(report));
  print_json(json);
}

ExitCode run(const OdometryCommandOptions& options, const CommonOptions& common) {
  odometry_options(options);
  ReadingReport listing;
  const std::vector<std::filesystem::path> all_files = list_inputs(options.scans, listing);
  options.outputs.check(all_files);
  const std::vector<ScanPlace> all_scans = list_scans(all_files, options.read);
  const std::vector<ScanPlace> scans = select(all_scans, options.selection);
  if (scans.empty()) {
    throw std::invalid_argument(fmt::format("{} chooses none of {} scans", options.selection.text(), all_scans.size()));
  }

  listing.warn();
  const StopRequest stop;
  OdometryCollector collector(options.outputs);
  const std::vector<ScanReport> reports = follow(scans, options, stop, collector, common);
  if (stop.is_made()) spdlog::warn("stopped after {} of {} scans", reports.size(), scans.size());
  const auto format = options.format == "tum" ? TrajectoryFormat::kTum : TrajectoryFormat::kKitti;
  const Trajectory trajectory = trajectory_of(reports);
  if (format == TrajectoryFormat::kTum) warn_of_missing_times(trajectory, options.outputs.poses);
  write_trajectory(options.outputs.poses, trajectory, format);
  collector.write();
  print(reports, scans.size(), options, common.json);
  if (stop.is_made()) return stop.exit_code();
  return count_registered(reports) > 0 ? ExitCode::kDone : ExitCode::kNo;
}

}  // namespace

Command odometry_command() {
  return make_command<OdometryCommandOptions>(
      "odometry", "Follow a moving sensor from scan to scan",
      "vdbmap odometry velodyne/ -o odometry.txt\n"
      "vdbmap odometry velodyne/ -o odometry.txt --combined combined.ply --map local.vdb\n"
      "vdbmap odometry scans/ --every 2 --format tum -o odometry.tum --json",
      add_options, run);
}

}  // namespace vdbmap::cli
