// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace vdbmap::cli {

/// Declares an option of `count` finite numbers with commas between them, as in "--at 12.3,4.5,-1.6"; with count 0 of
/// one or more. `numbers` stays empty where the option is not given; `names` shows in the help: "X,Y,Z".
CLI::Option* add_number_list(CLI::App& app, const std::string& option, std::vector<double>& numbers, std::size_t count,
                             const std::string& names, const std::string& description);

}  // namespace vdbmap::cli
