// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "tools/cli/scan_selection.h"
#include "vdbmap/io/map_inputs.h"
#include "vdbmap/io/scans/scan_poses.h"

namespace vdbmap::cli {

/// Scans that become a map.
struct ChosenInputs {
  std::vector<MapInput> inputs;
  std::optional<ScanPoses> poses;  ///< of all scans, where a file of them is given
};

/// The chosen scans; with `poses`, each with the pose of its place in the sequence, and without those that have none,
/// which is logged. Throws std::invalid_argument where no scan is chosen, and IoError naming both counts where there
/// are fewer poses than scans, where no chosen scan has one, and as read_scan_poses().
ChosenInputs choose_inputs(const std::vector<ScanPlace>& scans, const ScanSelection& selection,
                           const std::optional<std::filesystem::path>& poses, PoseFrame frame = PoseFrame::kUnknown);

/// Gives each scan its .label file: `labels` itself for a single one, else NAME.label in the folder `labels` for the
/// scan file NAME.*. Throws IoError where one is missing, and std::invalid_argument for turns of a capture, and where
/// several scans would share a file.
void add_label_files(std::vector<MapInput>& inputs, const std::filesystem::path& labels);

}  // namespace vdbmap::cli
