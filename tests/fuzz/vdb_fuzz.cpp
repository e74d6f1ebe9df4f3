// SPDX-License-Identifier: GPL-3.0-or-later
// What `info` and `check` do with a file of another program.
#include "tests/fuzz/openvdb_child.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/io/vdb/vdb_description.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vdbmap::fuzz::read_with_openvdb(data, size, {}, [](const auto& path) {
    vdbmap::describe_vdb(path);
    vdbmap::check_vdb_file(path);
  });
}
