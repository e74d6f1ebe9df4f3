// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/pose_frame.h"

#include <map>
#include <string>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <nlohmann/json.hpp>

namespace vdbmap::cli {
namespace {

const std::map<std::string, PoseFrame> kFrames = {
    {"auto", PoseFrame::kUnknown}, {"lidar", PoseFrame::kLidar}, {"camera", PoseFrame::kCamera}};

}  // namespace

void add_pose_frame(CLI::App& app, PoseFrame& frame) {
  app.add_option_function<std::string>(
         "--pose-frame", [&frame](const std::string& name) { frame = kFrames.at(name); },
         "Whose the poses are: lidar, or camera as KITTI's and SemanticKITTI's, which the calib.txt beside the poses, "
         "beside the scans or above their folder moves to the LiDAR; auto: camera where they go along their z axis "
         "while the first scan lies level, [auto]")
      ->check(CLI::IsMember({"auto", "lidar", "camera"}).description(""))
      ->type_name("NAME");
}

void add_pose_frame(nlohmann::ordered_json& json, const ScanPoses& poses) {
  json["pose_frame"] = poses.frame == PoseFrame::kCamera ? "camera" : "lidar";
  if (!poses.calibration.empty()) json["calibration"] = poses.calibration.string();
}

}  // namespace vdbmap::cli
