// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace vdbmap {

/// The order of scans by their names: numbers in them count by value, fractions as in "1403636579.05.pcd" included,
/// letters in either case. A number is a fraction where one point stands between two runs of digits: "1.5", but not
/// "1.2.3"; one at the front of a name or behind '_' may be negative.
bool comes_before(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace vdbmap
