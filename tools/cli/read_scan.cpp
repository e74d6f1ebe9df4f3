// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/read_scan.h"

#include <utility>

#include "vdbmap/core/error.h"

namespace vdbmap::cli {

std::optional<PointCloud> read_scan(ScanReader& reader, const ScanPlace& scan, ReadingReport& report,
                                    std::string& reason) {
  try {
    ReadResult read = reader.read(scan);
    report.add(scan.file, read.findings);
    return std::move(read.cloud);
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed || reader.options().strict) throw;
    reason = error.what();
    return std::nullopt;
  }
}

}  // namespace vdbmap::cli
