// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "tools/cli/reading.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap::cli {

/// A scan of a sequence, what was found in its file going to `report`; nothing, and the reason, where its content is
/// damaged: the others can still be used. Throws IoError where the file cannot be read at all, and for damage too where
/// the reader is strict.
std::optional<PointCloud> read_scan(ScanReader& reader, const ScanPlace& scan, ReadingReport& report,
                                    std::string& reason);

}  // namespace vdbmap::cli
