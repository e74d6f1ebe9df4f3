// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap::cli {

/// How certain the places of scans are, as localize reported them.
struct PoseCertainty {
  std::map<std::string, double> sigmas;  ///< [m] by the scan's name

  /// Standard deviation [m] of a scan's position in the direction where it is largest; nothing where the report does
  /// not know the scan.
  std::optional<double> position_sigma(const ScanPlace& scan) const;
};

/// Reads the report of `localize`. Throws IoError for anything else.
PoseCertainty read_pose_certainty(const std::filesystem::path& report);

}  // namespace vdbmap::cli
