// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vdbmap::test {

/// How a LAZ file is laid out.
struct LazLayout {
  unsigned version = 0;    ///< of the items; 0: what LASzip writes, 2 or 3
  bool is_chunked = true;  ///< point-wise: else one chunk without a table, as LASzip 1 wrote
  std::size_t points_per_chunk = 50000;
  std::vector<std::size_t> chunk_sizes;  ///< points of each; not empty: a table of variable size
  bool has_table = true;
  bool has_offset_behind =
      false;  ///< the place of the table stands at the end of the file, as where it cannot be sought
};

/// Compresses a LAS file of point format 0 to 3 or 6 to 8, as LasBytes makes it or as it was found: a small LAZ writer
/// that is good for tests alone. What laz-perf reads of it is what it was made of.
std::string compress_las(std::string_view las, const LazLayout& layout = {});

/// A LAS file of points as a scanner leaves them, and of some that no scanner does: repeated and jumping positions,
/// several returns and channels, times of interleaved sequences, colours grey and not, extra bytes. No point is
/// withheld.
std::string random_las(unsigned format, std::size_t num_points, std::size_t num_extra_bytes, std::uint64_t seed);

}  // namespace vdbmap::test
