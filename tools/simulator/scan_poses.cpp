// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/scan_poses.h"

#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::simulator {

ScanPoses::ScanPoses(const std::vector<SimulationRecord::MappedEpoch>& mapped)
    : mapped_(mapped), in_survey_(mapped.size()) {}

void ScanPoses::append(const Survey& scan, const Eigen::Isometry3d& scene_from_vehicle,
                       const Eigen::Isometry3d& vehicle_from_scan, double start,
                       const Eigen::Isometry3d& map_from_scene) {
  const Eigen::Isometry3d scene_from_scan = scene_from_vehicle * vehicle_from_scan;
  const double time = scan.cloud.times.empty() ? start : scan.cloud.times.front();
  true_poses_.times.push_back(time);
  true_poses_.map_from_scan.emplace_back(map_from_scene * scene_from_vehicle * vehicle_from_scan);
  std::vector<Eigen::Vector3d> points;
  if (!mapped_.empty()) {
    for (const Eigen::Vector3d& point : scan.cloud.positions) points.push_back(scene_from_scan * point);
  }
  for (std::size_t i = 0; i < mapped_.size(); ++i) {
    in_survey_[i].times.push_back(time);
    const auto survey_from_scene = mapped_[i].frame.survey_from_scene(points);
    if (survey_from_scene) {
      in_survey_[i].map_from_scan.emplace_back(map_from_scene * *survey_from_scene * scene_from_scan);
    } else {
      in_survey_[i].map_from_scan.emplace_back(std::nullopt);
    }
  }
}

void ScanPoses::write(const std::filesystem::path& folder, const std::string& name) const {
  write_trajectory(folder / (name + ".txt"), true_poses_, TrajectoryFormat::kKitti);
  write_trajectory(folder / (name + ".tum"), true_poses_, TrajectoryFormat::kTum);
  for (std::size_t i = 0; i < mapped_.size(); ++i) {
    write_trajectory(folder / (name + "_in_survey" + std::to_string(mapped_[i].epoch) + ".txt"), in_survey_[i],
                     TrajectoryFormat::kKitti);
  }
}

}  // namespace vdbmap::simulator
