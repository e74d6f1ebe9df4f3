// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "tools/cli/build_inputs.h"
#include "tools/cli/class_options.h"
#include "tools/cli/common_options.h"
#include "tools/cli/reading.h"
#include "vdbmap/io/map_from_files.h"

namespace vdbmap::cli {

/// What commands that make a map of point files are told of the points and of the map.
struct MapBuildOptions {
  std::vector<std::filesystem::path> inputs;
  std::optional<std::filesystem::path> poses;
  PoseFrame pose_frame = PoseFrame::kUnknown;
  ScanSelection selection;
  std::optional<double> voxel_size;
  std::vector<double> levels;
  std::vector<double> anchor;
  std::optional<int> epsg;
  std::optional<std::int32_t> epoch;
  ClassOptions classes;
  std::optional<double> min_range;  // [m]
  std::optional<double> max_range;  // [m]
  ReadOptions read;
};

/// Declares INPUTS and all of these options; returns that of --poses.
CLI::Option* add_map_build_options(CLI::App& app, MapBuildOptions& options);

/// What the options say of the map. Throws std::invalid_argument for those that cannot be.
BuildOptions build_options(const MapBuildOptions& options);

/// The same for points that go into a city, which keeps its anchor and density and, where the command says nothing of
/// them, its levels.
BuildOptions build_options_into(const std::filesystem::path& city, const MapBuildOptions& options, float density);

/// How the inputs become a map of these options. Throws std::invalid_argument for a range that cannot be.
MapFromFilesOptions files_options(const BuildOptions& build, const MapBuildOptions& command,
                                  const CommonOptions& common);

/// The files that the options name, outside the point files in INPUTS.
std::vector<std::filesystem::path> named_files(const MapBuildOptions& options);

/// The inputs of the scans, with the poses and labels that the options give them.
ChosenInputs chosen_inputs(const std::vector<ScanPlace>& all, const MapBuildOptions& options);

/// Warns where a scheme of labels is given and the files hold none.
void warn_without_labels(const std::string& label_scheme, bool has_labels);

}  // namespace vdbmap::cli
