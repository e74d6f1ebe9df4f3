// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/localize_modes.h"

#include <string>
#include <utility>

#include "registration/guided_localizer.h"
#include "registration/sequence.h"
#include "tools/cli/progress.h"
#include "tools/cli/read_scan.h"
#include "vdbmap/core/error.h"

namespace vdbmap::cli {
LocalizeReport localize_from_guesses(const ChosenScans& scans, const MapWindows& map, const Trajectory& guesses,
                                     const registration::FineOptions& fine, const registration::FoundCriteria& criteria,
                                     const ReadOptions& read, const CommonOptions& common) {
  registration::GuidedLocalizer localizer(map, fine, criteria);
  const bool are_followed = guesses.size() == 1;
  if (are_followed) localizer.follow_from(guesses.map_from_scan.front().value());
  Progress progress("localizing scans", scans.places.size(), common);
  ScanReader reader(read);
  LocalizeReport report;
  for (std::size_t i = 0; i < scans.places.size(); ++i) {
    std::string reason;
    const std::optional<PointCloud> scan = read_scan(reader, scans.places[i], report.reading, reason);
    if (!scan) {
      localizer.skip(reason);
    } else if (are_followed) {
      localizer.add(*scan);
    } else {
      localizer.add(*scan, guesses.map_from_scan[i]);
    }
    localizer.pass_over(scans.num_left_out);
    progress.advance();
  }
  const std::vector<registration::LocalizedScan> results = localizer.finish();
  for (std::size_t i = 0; i < results.size(); ++i) report.scans.push_back(row_of(scans.places[i], results[i]));
  return report;
}

LocalizeReport localize_without_guess(const ChosenScans& scans, const MapWindows& map,
                                      const std::optional<Trajectory>& odometry,
                                      const registration::LocalizerOptions& options, const ReadOptions& read,
                                      const CommonOptions& common) {
  registration::OdometryOptions odometry_options;
  odometry_options.range = options.fine.range;
  registration::SequenceLocalizer localizer(map, options, odometry_options);
  Progress progress("localizing scans", scans.places.size(), common);
  ScanReader reader(read);
  LocalizeReport report;
  for (std::size_t i = 0; i < scans.places.size(); ++i) {
    std::string reason;
    std::optional<PointCloud> scan = read_scan(reader, scans.places[i], report.reading, reason);
    if (!scan) {
      localizer.skip(reason);
    } else if (odometry) {
      localizer.add(std::move(*scan), odometry->map_from_scan[i]);
    } else {
      localizer.add(std::move(*scan));
    }
    localizer.pass_over(scans.num_left_out);
    progress.advance();
  }

  registration::SequenceResult result = localizer.finish();
  report.batches = std::move(result.batches);
  for (std::size_t i = 0; i < scans.places.size(); ++i)
    report.scans.push_back(row_of(scans.places[i], result.scans[i]));
  return report;
}

}  // namespace vdbmap::cli
