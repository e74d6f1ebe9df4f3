// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/read_scan.h"

#include "vdbmap/core/error.h"

namespace vdbmap::cli {

std::optional<PointCloud> read_scan(ScanReader& reader, const ScanPlace& scan, std::string& reason) {
  try {
    return reader.read(scan).cloud;
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed) throw;
    reason = error.what();
    return std::nullopt;
  }
}

}  // namespace vdbmap::cli
