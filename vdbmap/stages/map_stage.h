// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/stages/source_part.h"

namespace vdbmap {

/// How a source is mapped; its bytes do not depend on it.
struct MapStageOptions {
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< files of points not counted, as for build_city()
  bool skips_bad = false;  ///< a source whose content cannot be read is left out, instead of stopping the job
  bool reads_ahead = true;
};

/// What became of a source.
enum class MapOutcome {
  kDone,
  kWasThere,  ///< its part is there already
  kLeftOut,
};

/// Reads a source once, hashed on the way, and writes its part. A part that is there and whole stays; any other file in
/// its place is replaced. Throws IoError naming the source that cannot be read, that has another size than planned or
/// changes while it is read; std::invalid_argument for a number that the plan has not.
MapOutcome map_source(const Job& job, std::size_t source, const MapStageOptions& options);

/// Whether the part of a source is there, of this plan and whole at its end. Throws IoError (system).
bool has_part(const Job& job, std::size_t source);

}  // namespace vdbmap
