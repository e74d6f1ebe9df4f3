// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/json_output.h"

#include <CLI/Option.hpp>

namespace vdbmap::cli {

void add_json_output(CLI::App& app, JsonOutput& output, const std::string& others) {
  const auto take = [&output](const CLI::results_t& words) {
    output.is_wanted = true;
    output.file = words.front();
    return true;
  };
  const auto check = [others](const std::string& name) -> std::string {
    if (name.empty() || name.ends_with(".json")) return "";
    return "would write into '" + name + "', expected a name that ends in .json; put --json behind " + others;
  };
  app.add_option("--json", take, "Print the result as JSON, or write it to FILE (.json) and print the table")
      ->expected(0, 1)
      ->check(check)
      ->type_name("[FILE]");
}

}  // namespace vdbmap::cli
