// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::registration {

/// What the time stamps of a scan are good for.
struct ScanTiming {
  std::optional<double> first;  ///< [s] time of the first point; nothing where the times cannot be used
  double interval = 0.1;        ///< [s] from the scan before to this one
  double usual_interval = 0.1;  ///< [s] as it was between the scans before
  double elapsed = 0;           ///< [s] since the first scan of the sequence began; never stands still
  std::string problem;          ///< why the scan's times cannot be used; empty also where it has none
};

/// Looks at the times of scan after scan. Their epoch may be common to all scans or begin anew with each; then, and
/// without usable times, a scan is taken to begin where the one before ends.
class ScanClock {
 public:
  ScanTiming next(const PointCloud& scan);

 private:
  ScanTiming judge(const PointCloud& scan);

  std::optional<double> last_first_;  // [s]
  double last_interval_ = 0.1;        // [s] of a scanner that turns ten times a second, until known
  std::optional<double> elapsed_;     // [s] of the last scan
};

}  // namespace vdbmap::registration
