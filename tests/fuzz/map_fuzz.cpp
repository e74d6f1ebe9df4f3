// SPDX-License-Identifier: GPL-3.0-or-later
// The seeds carry no checksum of ours, as maps that another program wrote again: else every change would end there.
#include "tests/fuzz/fuzz_file.h"
#include "vdbmap/io/vdb/map_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vdbmap::fuzz::read(data, size, [](const auto& path) {
    if (vdbmap::is_map_file(path)) vdbmap::load_map(path);
  });
}
