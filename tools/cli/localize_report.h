// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>

#include "registration/localize.h"
#include "registration/localizer.h"
#include "tools/cli/reading.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/scans/scan_poses.h"
#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap::cli {

/// What became of one scan, however it was localized.
struct LocalizedRow {
  ScanPlace scan;
  Eigen::Isometry3d map_from_scan = Eigen::Isometry3d::Identity();  ///< the best known, also if not found
  registration::Matrix6d covariance = registration::Matrix6d::Zero();
  double inlier_share = 0;  ///< of the sampled points: within 0.15 m of a plane of the map
  std::vector<std::string> unobservable;
  std::string reason;        ///< empty when found
  std::string time_problem;  ///< why it was not deskewed; empty where nothing is wrong

  bool found() const { return reason.empty(); }
};

/// What `vdbmap localize` says.
struct LocalizeReport {
  std::vector<LocalizedRow> scans;
  std::vector<registration::SequenceBatch> batches;  ///< of a search without a first guess, else empty
  ReadingReport reading;                             ///< what was found in the files
  std::optional<ScanPoses> given;                    ///< guesses, or poses of odometry

  std::size_t num_found() const;

  /// With a pose for each scan that was found, and the times of the poses given where there is one a scan.
  Trajectory trajectory() const;
};

LocalizedRow row_of(const ScanPlace& scan, const registration::LocalizedScan& localized);
LocalizedRow row_of(const ScanPlace& scan, const registration::SequenceScan& localized);

/// One warning for each scan and batch that was not found, and for what the map does not determine.
void warn(const LocalizeReport& report);

/// Everything, for --json and --report; `output` is the file of poses.
nlohmann::ordered_json json_of(const LocalizeReport& report, const std::filesystem::path& output);

}  // namespace vdbmap::cli
