// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::registration {

/// What the time stamps of a scan are good for.
struct ScanTiming {
  std::optional<double> first;  ///< [s] time of the first point; nothing where the times cannot be used
  double interval = 0.1;        ///< [s] from the scan before to this one
  double usual_interval = 0.1;  ///< [s] the same, by the usual interval of the scans before
  double elapsed = 0;           ///< [s] since the first scan of the sequence began; never stands still
  std::string problem;          ///< why the scan's times cannot be used; empty also where it has none
};

/// Looks at the times of scan after scan. Their epoch may be common to all scans or begin anew with each; then, and
/// without usable times, a scan is taken to begin where the one before it in the sequence ends.
class ScanClock {
 public:
  ScanTiming next(const PointCloud& scan);

  /// So many scans of the sequence are left out before the next: no time stamp that begins anew tells of them.
  void pass_over(std::size_t num_scans) { num_turns_ += static_cast<double>(num_scans); }

 private:
  ScanTiming judge(const PointCloud& scan);

  std::optional<double> last_first_;  // [s] time stamp of the last scan with usable ones
  double since_last_first_ = 0;       // [s] that the scans after it were given
  double usual_turn_ = 0.1;           // [s] from a scan of the sequence to the next; ten turns a second, until known
  double num_turns_ = 1;              // to the next scan: one more than are left out before it
  std::optional<double> elapsed_;     // [s] of the last scan
};

}  // namespace vdbmap::registration
