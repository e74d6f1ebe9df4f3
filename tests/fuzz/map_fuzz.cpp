// SPDX-License-Identifier: GPL-3.0-or-later
// The seeds carry no checksum of ours, as maps that another program wrote again: else every change would end there.
#include "tests/fuzz/openvdb_child.h"
#include "vdbmap/io/vdb/map_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto is_of_map = [](const std::string& name) { return name.starts_with("voxels"); };
  return vdbmap::fuzz::read_with_openvdb(data, size, is_of_map, [](const auto& path) {
    if (vdbmap::is_map_file(path)) vdbmap::load_map(path);
  });
}
