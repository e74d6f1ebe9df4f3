// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/stages/job_folder.h"
#include "vdbmap/store/part_file.h"

/// The parts of a job's sources.
namespace vdbmap {

/// Writes the part of a source, its tiles by bucket, and takes its sums. Throws IoError (system).
void write_part(const Job& job, std::size_t source, const PartNotes& found, TileSums& sums);

/// Opens the part of a source. Throws IoError: malformed where it was cut, is damaged, of another version, plan or
/// source.
Part open_part(const Job& job, std::size_t source);

}  // namespace vdbmap
