// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/fuzz_file.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap::fuzz {

/// Whether read_vdb() reads the wanted grids of a file, rather than refusing them by an IoError. Tried in a child
/// process, which has a second of processor time and a gigabyte: OpenVDB breaks on some damaged files (it crashes,
/// takes all memory, runs for hours), in code that is not ours, and the command reads foreign files in a child for that
/// reason. What breaks it is no finding, but goes to the folder that the environment names, VDBMAP_KEEP_BROKEN, for the
/// command to be asked about it. Another exception than IoError is a finding, and aborts.
bool openvdb_reads(const std::uint8_t* data, std::size_t size, const GridFilter& is_wanted = {});

/// As read(), for files that OpenVDB reads: those that it has read in a child are read once more in this process, where
/// whatever else happens is a finding. Refused files are not: OpenVDB loses the nodes that it was reading.
template <typename Read>
int read_with_openvdb(const std::uint8_t* data, std::size_t size, const GridFilter& is_wanted, const Read& read_file) {
  return openvdb_reads(data, size, is_wanted) ? read(data, size, read_file) : 0;
}

}  // namespace vdbmap::fuzz
