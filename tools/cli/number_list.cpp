// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/number_list.h"

#include <cmath>
#include <optional>
#include <string_view>

#include <CLI/Error.hpp>
#include <CLI/Option.hpp>

#include "vdbmap/io/file/text.h"

namespace vdbmap::cli {
namespace {

// Nothing where a part is not a finite number.
std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (bool is_last = false; !is_last;) {
    const std::size_t comma = text.find(',');
    is_last = comma == std::string_view::npos;
    const std::optional<double> number = parse_number(text.substr(0, comma));
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
    if (!is_last) text.remove_prefix(comma + 1);
  }
  return numbers;
}

}  // namespace

CLI::Option* add_number_list(CLI::App& app, const std::string& option, std::vector<double>& numbers, std::size_t count,
                             const std::string& names, const std::string& description) {
  const auto parse = [&numbers, option, count, names](const std::string& text) {
    const std::optional<std::vector<double>> parsed = parse_numbers(text);
    if (!parsed || (count > 0 && parsed->size() != count)) {
      throw CLI::ValidationError(option, "is '" + text + "', expected numbers as in " + names);
    }
    numbers = *parsed;
  };
  return app.add_option_function<std::string>(option, parse, description)->type_name(names);
}

}  // namespace vdbmap::cli
