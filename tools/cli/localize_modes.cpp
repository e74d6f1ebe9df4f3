// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/localize_modes.h"

#include <functional>
#include <string>
#include <utility>

#include "registration/sequence.h"
#include "tools/cli/progress.h"
#include "tools/cli/read_scan.h"
#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

using registration::ConstantVelocity;
using registration::LocalizedScan;

using Localize = std::function<LocalizedScan(const ScanPlace&, const Eigen::Isometry3d& guess)>;

LocalizeReport localize_each(const std::vector<ScanPlace>& scans, const Trajectory& guesses, const Localize& localize,
                             Progress& progress) {
  LocalizeReport report;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto& guess = guesses.map_from_scan[i];
    report.scans.push_back(row_of(scans[i], guess ? localize(scans[i], *guess) : LocalizedScan{{}, "no guess"}));
    progress.advance();
  }
  return report;
}

LocalizeReport follow_motion(const std::vector<ScanPlace>& scans, const Eigen::Isometry3d& first_guess,
                             const Localize& localize, Progress& progress) {
  LocalizeReport report;
  ConstantVelocity motion(first_guess);
  for (const ScanPlace& scan : scans) {
    const LocalizedScan localized = localize(scan, motion.guess());
    if (localized.found()) {
      motion.found(localized.fine.map_from_scan);
    } else {
      motion.lost();
    }
    report.scans.push_back(row_of(scan, localized));
    progress.advance();
  }
  return report;
}

}  // namespace

LocalizeReport localize_from_guesses(const std::vector<ScanPlace>& scans, const VoxelMap& map,
                                     const Trajectory& guesses, const registration::FineOptions& fine,
                                     const registration::FoundCriteria& criteria, const ReadOptions& read,
                                     const CommonOptions& common) {
  ScanReader reader(read);
  ReadingReport reading;
  const Localize localize = [&](const ScanPlace& scan, const Eigen::Isometry3d& guess) {
    const ReadResult result = reader.read(scan);
    reading.add(scan.file, result.findings);
    return registration::localize_scan(result.cloud, map, guess, fine, criteria);
  };
  Progress progress("localizing scans", scans.size(), common);
  LocalizeReport report = guesses.size() != 1
                              ? localize_each(scans, guesses, localize, progress)
                              : follow_motion(scans, guesses.map_from_scan.front().value(), localize, progress);
  report.reading = std::move(reading);
  return report;
}

LocalizeReport localize_without_guess(const std::vector<ScanPlace>& scans, const VoxelMap& map,
                                      const std::optional<Trajectory>& odometry,
                                      const registration::LocalizerOptions& options, const ReadOptions& read,
                                      const CommonOptions& common) {
  registration::OdometryOptions odometry_options;
  odometry_options.range = options.fine.range;
  registration::SequenceLocalizer localizer(map, options, odometry_options);
  Progress progress("localizing scans", scans.size(), common);
  ScanReader reader(read);
  LocalizeReport report;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    std::string reason;
    std::optional<PointCloud> scan = read_scan(reader, scans[i], report.reading, reason);
    if (!scan) {
      localizer.skip(reason);
    } else if (odometry) {
      localizer.add(std::move(*scan), odometry->map_from_scan[i]);
    } else {
      localizer.add(std::move(*scan));
    }
    progress.advance();
  }

  registration::SequenceResult result = localizer.finish();
  report.batches = std::move(result.batches);
  for (std::size_t i = 0; i < scans.size(); ++i) report.scans.push_back(row_of(scans[i], result.scans[i]));
  return report;
}

}  // namespace vdbmap::cli
