// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/epoch_date.h"

#include <chrono>
#include <cstdio>
#include <stdexcept>

namespace vdbmap::cli {

void add_epoch_date(CLI::App& app, std::string& date) {
  app.add_option("--date", date, "Day of the survey or drive, kept with its epoch")->type_name("YYYY-MM-DD");
}

void check_epoch_date(const std::string& date) {
  if (date.empty()) return;
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  int length = 0;
  const bool is_read = std::sscanf(date.c_str(), "%4d-%2u-%2u%n", &year, &month, &day, &length) == 3 && length == 10 &&
                       date.size() == 10;
  if (is_read &&
      std::chrono::year_month_day(std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)).ok()) {
    return;
  }
  throw std::invalid_argument("--date is '" + date + "', expected a day as 2023-09-14");
}

}  // namespace vdbmap::cli
