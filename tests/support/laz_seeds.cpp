// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/laz_seeds.h"

#include "tests/support/laz_bytes.h"

namespace vdbmap::test {

std::vector<LazSeed> laz_seeds() {
  std::vector<LazSeed> seeds;
  for (const unsigned format : {0U, 1U, 2U, 3U, 6U, 7U, 8U}) {
    const unsigned lowest_version = format >= 6 ? 3 : 1;
    for (const unsigned version : {lowest_version, lowest_version + 1}) {
      const std::string name = "format" + std::to_string(format) + "_version" + std::to_string(version);
      const std::string las = random_las(format, 40, 0, 1);
      const auto add = [&](const std::string& what, const std::string& of, const LazLayout& layout) {
        seeds.push_back({name + what + ".laz", compress_las(of, layout)});
      };
      add("", las, {.version = version, .points_per_chunk = 15, .chunk_sizes = {}});
      add("_extra", random_las(format, 40, 2, 2), {.version = version, .points_per_chunk = 30, .chunk_sizes = {}});
      add("_variable", las, {.version = version, .chunk_sizes = {10, 1, 29}});
      if (version == 1) add("_one", las, {.version = version, .is_chunked = false, .chunk_sizes = {}});
    }
  }
  return seeds;
}

}  // namespace vdbmap::test
