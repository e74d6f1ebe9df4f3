// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include <CLI/App.hpp>

namespace vdbmap::cli {

/// Where a command that also writes a report as JSON puts it.
struct JsonOutput {
  bool is_wanted = false;
  std::filesystem::path file;  ///< empty: stdout, instead of the report for people

  bool is_on_stdout() const { return is_wanted && file.empty(); }
};

/// Declares --json [FILE]. CLI11 takes the word behind it for the file's name, so a word that does not end in .json is
/// refused; `others` are what it may have been meant to be: "the poses".
void add_json_output(CLI::App& app, JsonOutput& output, const std::string& others);

}  // namespace vdbmap::cli
