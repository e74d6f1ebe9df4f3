// SPDX-License-Identifier: GPL-3.0-or-later
// What `info` and `check` do with a file of another program.
#include "tests/fuzz/fuzz_file.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/io/vdb/vdb_description.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vdbmap::fuzz::read(data, size, [](const auto& path) { vdbmap::describe_vdb(path); });
  return vdbmap::fuzz::read(data, size, [](const auto& path) { vdbmap::check_vdb_file(path); });
}
