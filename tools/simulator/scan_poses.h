// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/simulator/simulation_record.h"
#include "tools/simulator/survey.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::simulator {

/// The poses of a drive's scans: the true ones, and those that they have in the frame of each survey before.
class ScanPoses {
 public:
  /// The surveys must outlive it.
  explicit ScanPoses(const std::vector<SimulationRecord::MappedEpoch>& mapped);

  /// Appends a scan; `start` [s] is its time where it has no point.
  void append(const Survey& scan, const Eigen::Isometry3d& scene_from_vehicle,
              const Eigen::Isometry3d& vehicle_from_scan, double start, const Eigen::Isometry3d& map_from_scene);

  /// Writes NAME.txt (KITTI), NAME.tum, and NAME_in_surveyE.txt for the survey of epoch E; a pose that no pass of it
  /// saw is missing there. Throws IoError.
  void write(const std::filesystem::path& folder, const std::string& name) const;

 private:
  const std::vector<SimulationRecord::MappedEpoch>& mapped_;
  Trajectory true_poses_;
  std::vector<Trajectory> in_survey_;
};

}  // namespace vdbmap::simulator
