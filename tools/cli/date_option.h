// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace vdbmap::cli {

/// Declares --date: `what` it is the date of. Refuses what is no date of ISO 8601.
void add_date(CLI::App& app, std::string& date, const std::string& what);

}  // namespace vdbmap::cli
