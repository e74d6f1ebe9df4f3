// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vdbmap::cli {

/// "0-3,7" as 0, 1, 2, 3, 7: the numbers that job arrays of Slurm are given. Throws std::invalid_argument for other
/// texts.
std::vector<std::size_t> parse_ranges(std::string_view text);

/// The same text of rising numbers, as short as it can be; empty without any.
std::string ranges_text(const std::vector<std::size_t>& numbers);

}  // namespace vdbmap::cli
