// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "registration/localize.h"
#include "registration/localizer.h"
#include "tools/cli/common_options.h"
#include "tools/cli/localize_report.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/scans/scan_sequence.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::cli {

/// Scans chosen of a sequence.
struct ChosenScans {
  std::vector<ScanPlace> places;
  std::size_t num_left_out = 0;  ///< between one and the next
};

/// Each scan from a guess of its own, or, where there is one guess only, from the motion of those before.
LocalizeReport localize_from_guesses(const ChosenScans& scans, const MapWindows& map, const Trajectory& guesses,
                                     const registration::FineOptions& fine, const registration::FoundCriteria& criteria,
                                     const ReadOptions& read, const CommonOptions& common);

/// The whole sequence without a first guess; with the poses of an odometry made before, or our own.
LocalizeReport localize_without_guess(const ChosenScans& scans, const MapWindows& map,
                                      const std::optional<Trajectory>& odometry,
                                      const registration::LocalizerOptions& options, const ReadOptions& read,
                                      const CommonOptions& common);

}  // namespace vdbmap::cli
