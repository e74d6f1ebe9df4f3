// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include <CLI/App.hpp>

#include "tools/cli/output_ending.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {

/// Where a command writes its map, and how.
struct MapOutput {
  std::filesystem::path file;
  SaveOptions save;
};

/// Declares --output, which may be the folder of a city where the command can make one, and --density.
void add_map_output(CLI::App& app, MapOutput& output, bool may_be_city = false);

/// Declares --density alone.
void add_density(CLI::App& app, SaveOptions& save);

/// Before the work: throws std::invalid_argument where the output's name stands for another format or is that of one of
/// the inputs, IoError where it cannot be written.
void check_output(const std::filesystem::path& output, const OutputKind& kind,
                  const std::vector<std::filesystem::path>& inputs);

}  // namespace vdbmap::cli
