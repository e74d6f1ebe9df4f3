// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las_columns.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_records.h"

namespace vdbmap::laz {

/// Decodes the chunks on all threads allowed; those that are not whole are left out, and their points counted. Takes
/// memory for no more points than the chunks have bytes, or than were found to be in them. Throws IoError where the
/// compression is not one that LASzip writes, and for waveforms.
LasPoints read_laz_points(const ByteReader& file, const LasHeader& header, const LasRecords& records);

}  // namespace vdbmap::laz
