// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json_fwd.hpp>

#include "vdbmap/io/scans/scan_poses.h"

namespace vdbmap::cli {

/// Declares --pose-frame, for commands that read poses of scans.
void add_pose_frame(CLI::App& app, PoseFrame& frame);

/// Whose the poses were: `pose_frame`, and the `calibration` that moved them.
void add_pose_frame(nlohmann::ordered_json& json, const ScanPoses& poses);

}  // namespace vdbmap::cli
