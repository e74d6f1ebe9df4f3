// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace vdbmap::cli {

/// Declares --date, the day of a survey or drive.
void add_epoch_date(CLI::App& app, std::string& date);

/// Throws std::invalid_argument unless the date is empty or a day of the calendar as YYYY-MM-DD.
void check_epoch_date(const std::string& date);

}  // namespace vdbmap::cli
