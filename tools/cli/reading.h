// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap::cli {

/// Declares the options of every command that reads points: --strict and --sensor.
void add_read_options(CLI::App& app, ReadOptions& options);

/// What was noticed in the files of a command: one line for all that say the same.
class ReadingReport {
 public:
  void add(const std::filesystem::path& file, const ReadFinding& finding);
  void add(const std::filesystem::path& file, const std::vector<ReadFinding>& findings);

  void add(const std::vector<FileFinding>& findings);

  /// Logs a warning a finding: "a.las: 3 withheld points left out", "a.las and 2 more files: 9 withheld points left
  /// out".
  void warn() const;

  /// A list of objects `what`, `count`, `first`, `files`, `first_file`, `is_damage`.
  nlohmann::ordered_json json() const;

 private:
  struct Row {
    std::filesystem::path first_file;
    std::filesystem::path last_file;
    std::size_t num_files = 0;
    ReadFinding finding;
  };

  std::vector<Row> rows_;
};

/// The point files of a command's inputs; what was left out of their folders goes to `report`.
std::vector<std::filesystem::path> list_inputs(const std::vector<std::filesystem::path>& inputs, ReadingReport& report);

}  // namespace vdbmap::cli
