// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/fuzz_file.h"
#include "vdbmap/io/ply/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return vdbmap::fuzz::read(data, size, [](const auto& path) { vdbmap::read_ply(path); });
}
