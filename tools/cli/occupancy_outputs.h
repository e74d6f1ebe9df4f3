// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <CLI/App.hpp>

#include "parking/exchange/city_documents.h"
#include "parking/exchange/occupancy_files.h"
#include "tools/cli/common_options.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::cli {

/// What vdbmap occupancy writes.
struct OccupancyOutputs {
  std::filesystem::path json;
  std::optional<std::filesystem::path> geojson, csv, curbs, fiware, report;
  parking::GeoOptions geo;
  parking::CityOptions city;
};

/// Declares --output, --geojson, --csv, --cds, --fiware, --report, --city, --time-zone and those of GeoJSON.
void add_occupancy_outputs(CLI::App& app, OccupancyOutputs& outputs);

/// Before the work: throws as check_output() does, and where two outputs are the same.
void check_outputs(const OccupancyOutputs& outputs, const std::vector<std::filesystem::path>& inputs);

/// Writes what was asked for, each file atomically; all are made before the first is written.
void write_outputs(const OccupancyOutputs& outputs, const parking::OccupancyRecord& record, const VoxelMap& map,
                   const VoxelMap& later, const parking::GroundPlan& ground);

/// Prints the result, as JSON where asked for.
void print_summary(const OccupancyOutputs& outputs, const parking::OccupancyRecord& record,
                   const CommonOptions& common);

}  // namespace vdbmap::cli
