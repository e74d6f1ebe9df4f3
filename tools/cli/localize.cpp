// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/localize.h"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "tools/cli/scan_selection.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/map_file.h"
#include "vdbmap/io/scan_sequence.h"
#include "vdbmap/io/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using registration::ConstantVelocity;
using registration::LocalizedScan;

struct LocalizeCommandOptions {
  std::filesystem::path map;
  std::vector<std::filesystem::path> scans;
  std::filesystem::path initial;
  std::filesystem::path output;
  std::string format = "kitti";
  ScanSelection selection;
  registration::FineOptions fine;
  registration::FoundCriteria found;
};

// What became of one scan.
struct ScanReport {
  ScanPlace scan;
  LocalizedScan localized;
};

void add_options(CLI::App& app, LocalizeCommandOptions& options) {
  app.add_option("MAP", options.map, "The map (.vdb)")->type_name("FILE")->required();
  app.add_option("SCANS", options.scans,
                 "Scans in the frame of the sensor, and folders of them; of a Velodyne capture each turn is one")
      ->type_name("PATH...")
      ->required();
  app.add_option("--initial", options.initial,
                 "First guesses (KITTI or TUM), up to 2 m and 10 degrees off: one for each chosen scan, or a single "
                 "one for the first, from which the motion is followed")
      ->type_name("FILE")
      ->required();
  app.add_option("-o,--output", options.output, "Where to write the poses")->type_name("FILE")->required();
  app.add_option("--format", options.format, "Of the poses written: kitti or tum, [kitti]")
      ->check(CLI::IsMember({"kitti", "tum"}).description(""))
      ->type_name("NAME");
  app.add_option("--min-inliers", options.found.min_inlier_share,
                 "Share of the points that must lie on the map for a scan to count as found, [0.3]")
      ->check(CLI::Range(0.0, 1.0).description(""))
      ->type_name("SHARE");
  add_scan_selection(app, options.selection);
}

// One guess for every scan, or a single one for the first.
Trajectory read_guesses(const LocalizeCommandOptions& options, std::size_t num_scans) {
  const Trajectory guesses = read_trajectory(options.initial);
  if (guesses.size() == 1) return guesses;
  return read_selected_poses(options.initial, options.selection, num_scans);
}

LocalizedScan localize(const PointCloud& scan, const VoxelMap& map, const Eigen::Isometry3d& guess,
                       const LocalizeCommandOptions& options) {
  return registration::localize_scan(scan, map, guess, options.fine, options.found);
}

std::vector<ScanReport> localize_each(const std::vector<ScanPlace>& scans, const VoxelMap& map,
                                      const Trajectory& guesses, const LocalizeCommandOptions& options,
                                      Progress& progress) {
  std::vector<ScanReport> reports;
  ScanReader reader;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto& guess = guesses.map_from_scan[i];
    reports.push_back({scans[i], guess ? localize(reader.read(scans[i]).cloud, map, *guess, options)
                                       : LocalizedScan{{}, "no guess"}});
    progress.advance();
  }
  return reports;
}

std::vector<ScanReport> follow_motion(const std::vector<ScanPlace>& scans, const VoxelMap& map,
                                      const Eigen::Isometry3d& first_guess, const LocalizeCommandOptions& options,
                                      Progress& progress) {
  std::vector<ScanReport> reports;
  ScanReader reader;
  ConstantVelocity motion(first_guess);
  for (const ScanPlace& scan : scans) {
    reports.push_back({scan, localize(reader.read(scan).cloud, map, motion.guess(), options)});
    const LocalizedScan& localized = reports.back().localized;
    if (localized.found()) {
      motion.found(localized.fine.map_from_scan);
    } else {
      motion.lost();
    }
    progress.advance();
  }
  return reports;
}

std::vector<ScanReport> localize_all(const std::vector<ScanPlace>& scans, const VoxelMap& map,
                                     const Trajectory& guesses, const LocalizeCommandOptions& options,
                                     const CommonOptions& common) {
  Progress progress("localizing scans", scans.size(), common);
  if (guesses.size() != 1) return localize_each(scans, map, guesses, options, progress);
  if (!guesses.map_from_scan.front()) throw IoError::malformed(options.initial, "its only guess is missing");
  return follow_motion(scans, map, *guesses.map_from_scan.front(), options, progress);
}

Trajectory trajectory_of(const std::vector<ScanReport>& reports, const Trajectory& guesses) {
  Trajectory trajectory;
  for (const ScanReport& report : reports) {
    trajectory.map_from_scan.push_back(report.localized.found() ? std::optional(report.localized.fine.map_from_scan)
                                                                : std::nullopt);
  }
  if (guesses.times.size() == reports.size()) trajectory.times = guesses.times;
  return trajectory;
}

std::size_t count_found(const std::vector<ScanReport>& reports) {
  std::size_t count = 0;
  for (const ScanReport& report : reports) count += report.localized.found();
  return count;
}

template <typename Matrix>
nlohmann::ordered_json json_of_matrix(const Matrix& matrix) {
  auto rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    auto row = nlohmann::ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

nlohmann::ordered_json json_of(const ScanReport& report) {
  const registration::FineResult& fine = report.localized.fine;
  nlohmann::ordered_json json = {{"file", report.scan.file.string()}};
  if (report.scan.turn) json["turn"] = *report.scan.turn + 1;
  json["found"] = report.localized.found();
  if (!report.localized.found()) json["reason"] = report.localized.reason;
  json["map_from_scan"] = json_of_matrix(fine.map_from_scan.matrix().topRows<3>().eval());
  json["covariance"] = json_of_matrix(fine.covariance);
  json["inlier_share"] = fine.inlier_share;
  json["rms_distance_m"] = fine.rms_distance;
  json["points"] = fine.num_points;
  json["unobservable"] = nlohmann::ordered_json::array();
  for (const auto& direction : fine.unobservable) json["unobservable"].push_back(direction.description);
  return json;
}

void warn(const std::vector<ScanReport>& reports) {
  for (const ScanReport& report : reports) {
    if (!report.localized.found()) spdlog::warn("{}: not found: {}", report.scan.name(), report.localized.reason);
    for (const auto& direction : report.localized.fine.unobservable) {
      spdlog::warn("{}: the map does not determine {}", report.scan.name(), direction.description);
    }
  }
}

void print(const std::vector<ScanReport>& reports, const LocalizeCommandOptions& options, bool as_json) {
  const std::size_t num_found = count_found(reports);
  if (!as_json) {
    return print_result(fmt::format("{}: {} of {} scans found\n", options.output.string(), num_found, reports.size()));
  }
  nlohmann::ordered_json json = {{"file", options.output.string()}, {"scans", reports.size()}, {"found", num_found}};
  json["results"] = nlohmann::ordered_json::array();
  for (const ScanReport& report : reports) json["results"].push_back(json_of(report));
  print_json(json);
}

ExitCode run(const LocalizeCommandOptions& options, const CommonOptions& common) {
  const std::vector<std::filesystem::path> files = list_point_files(options.scans);
  check_output(options.output, files);
  check_output(options.output, {options.map, options.initial});
  const std::vector<ScanPlace> scans = select(list_scans(files), options.selection);
  const Trajectory guesses = read_guesses(options, scans.size());
  const VoxelMap map = load_map(options.map);

  const std::vector<ScanReport> reports = localize_all(scans, map, guesses, options, common);
  warn(reports);
  const auto format = options.format == "tum" ? TrajectoryFormat::kTum : TrajectoryFormat::kKitti;
  write_trajectory(options.output, trajectory_of(reports, guesses), format);
  print(reports, options, common.json);
  return count_found(reports) > 0 ? ExitCode::kDone : ExitCode::kNo;
}

}  // namespace

Command localize_command() {
  return make_command<LocalizeCommandOptions>(
      "localize", "Find scans in a map, from a first guess",
      "vdbmap localize map.vdb velodyne/ --initial guesses.txt -o poses.txt\n"
      "vdbmap localize map.vdb velodyne/ --every 2 --offset 1 --initial guesses.txt -o poses.txt --json\n"
      "vdbmap localize map.vdb scan.pcd --initial guess.txt --format tum -o pose.tum",
      add_options, run);
}

}  // namespace vdbmap::cli
