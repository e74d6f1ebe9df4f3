// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "registration/localize.h"
#include "registration/odometry/scan_clock.h"
#include "registration/odometry/sensor_motion.h"
#include "registration/pose_at_time.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/store/map_windows.h"

namespace vdbmap::registration {

/// Localizes the scans of a sequence from first guesses: one for each, or one for the first, from which the motion is
/// followed. Scans with time stamps are deskewed with the motion between the scans found before and after them, so that
/// their poses are those of their first points, as the SequenceLocalizer's are; a scan that is the only one found is
/// taken as if the sensor had stood still. Memory: some
/// thousand points a scan; of a city the tiles around a few scans.
class GuidedLocalizer {
 public:
  /// Keeps a reference to a map in memory. Throws std::invalid_argument for bad options.
  explicit GuidedLocalizer(MapWindows map, const FineOptions& options = {}, const FoundCriteria& criteria = {});

  /// The next scan added is thought to be here, later ones where the motion leads to.
  void follow_from(const Eigen::Isometry3d& map_from_scan_guess);

  /// The next scan, followed: thought to be where the scans found so far lead to.
  void add(const PointCloud& scan);

  /// The next scan and its own guess, of its first point; without one it is not looked for.
  void add(const PointCloud& scan, const std::optional<Eigen::Isometry3d>& map_from_scan_guess);

  /// A scan that cannot even be read, and why.
  void skip(const std::string& reason);

  /// So many scans of the sequence are left out before the next, without a place in the result.
  void pass_over(std::size_t num_scans) { clock_.pass_over(num_scans); }

  /// A result for each scan added or skipped, in their order; the localizer is as new afterwards.
  std::vector<LocalizedScan> finish();

 private:
  // A scan thinned, and its result; until the end with the pose in the middle of its times.
  struct KeptScan {
    std::vector<Eigen::Vector3d> positions;  // [m] as measured; kept where they have times
    std::vector<double> times;               // [s] one a position, or none where they cannot be used
    double first_time = 0;                   // [s] by the time stamps
    double elapsed = 0;                      // [s] from the begin of the sequence to the first time
    double lead = 0;                         // [s] from the first time to the middle
    LocalizedScan result;
    bool is_deskewed = false;

    TimedPose middle() const { return {elapsed + lead, result.fine.map_from_scan}; }
  };

  KeptScan begin(const PointCloud& scan);
  void take(KeptScan scan, LocalizedScan result);
  bool is_placed(const LocalizedScan& result) const;
  bool tells_motion(const KeptScan& scan) const { return !scan.times.empty() && is_placed(scan.result); }
  LocalizedScan localize(const KeptScan& scan, const Vector6d& twist, const Eigen::Isometry3d& map_from_middle_guess,
                         bool search_headings) const;
  std::optional<TimedPose> neighbour(std::size_t number, bool is_before) const;
  void deskew_all();
  void take_deskewed(KeptScan& scan, LocalizedScan result) const;
  void move_to_first_points();

  MapWindows map_;
  FineOptions options_;
  FoundCriteria criteria_;
  ScanClock clock_;
  SensorMotion motion_;
  bool has_found_ = false;
  std::vector<KeptScan> scans_;
};

}  // namespace vdbmap::registration
