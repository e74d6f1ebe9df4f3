// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/date_option.h"

#include <CLI/Option.hpp>

#include "parking/spaces/iso_date.h"

namespace vdbmap::cli {
namespace {

std::string check_date(const std::string& text) {
  if (parking::milliseconds_of(text)) return "";
  return "is '" + text + "', expected a date like 2023-03-01 or 2023-03-01T10:20:30+01:00";
}

}  // namespace

void add_date(CLI::App& app, std::string& date, const std::string& what) {
  app.add_option("--date", date, "Date of " + what + " (ISO 8601)")->check(check_date)->type_name("DATE");
}

}  // namespace vdbmap::cli
