// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace vdbmap::test {

/// A file to begin fuzzing with.
struct LazSeed {
  std::string name;  ///< "format3_version2_extra.laz"
  std::string bytes;
};

/// A small file of every point format and version that LAZ is read in, with and without extra bytes, of several
/// layouts.
std::vector<LazSeed> laz_seeds();

}  // namespace vdbmap::test
