// SPDX-License-Identifier: GPL-3.0-or-later
// The list of grids of a .vdb file, which is read without OpenVDB and decides what it is asked to read.
#include "tests/fuzz/fuzz_file.h"
#include "vdbmap/io/vdb/vdb_outline.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vdbmap::fuzz::read(data, size, [](const auto& path) { vdbmap::read_vdb_outline(path); });
}
