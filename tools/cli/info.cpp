// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/child_process.h"
#include "tools/cli/city_summary.h"
#include "tools/cli/command.h"
#include "tools/cli/map_summary.h"
#include "tools/cli/output.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_description.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::filesystem::path file;
};

void add_options(CLI::App& app, InfoOptions& options) {
  app.add_option(
         "FILE", options.file,
         "A map, a city (the folder that build made, or one of its epochs: city@1), or a .vdb file of another program")
      ->type_name("FILE")
      ->required();
}

std::string text_of(const TextMetadata& metadata) {
  std::string text;
  for (const auto& [name, value] : metadata) text += fmt::format("  {}: {}\n", printable(name), printable(value));
  return text;
}

std::string text_of(const openvdb::Coord& index) { return fmt::format("{} {} {}", index.x(), index.y(), index.z()); }

std::string text_of(const GridDescription& grid) {
  std::string text = fmt::format("grid '{}': {}, {}\n  {} active voxels", printable(grid.name), printable(grid.type),
                                 printable(grid.grid_class), grid.num_active_voxels);
  if (const auto& box = grid.bounding_box) text += ", " + text_of(box->min()) + " to " + text_of(box->max());
  const openvdb::Vec3d& size = grid.voxel_size;
  text += fmt::format("\n  voxel size {:g} x {:g} x {:g}{}\n", size.x(), size.y(), size.z(),
                      grid.is_linear ? "" : " at the origin");
  return text + text_of(grid.metadata);
}

std::string text_of(const VdbDescription& description, const std::filesystem::path& file) {
  std::string text = fmt::format("{}: an OpenVDB file, but not a map of vdbmap\n", printable(file.string()));
  text += text_of(description.metadata);
  for (const GridDescription& grid : description.grids) text += text_of(grid);
  return text;
}

Json json_of(const TextMetadata& metadata) {
  Json json = Json::object();
  for (const auto& [name, value] : metadata) json[name] = value;
  return json;
}

Json json_of(const openvdb::Coord& index) { return {index.x(), index.y(), index.z()}; }

Json json_of(const GridDescription& grid) {
  Json box;
  if (grid.bounding_box) box = {{"min", json_of(grid.bounding_box->min())}, {"max", json_of(grid.bounding_box->max())}};
  return {
      {"name", grid.name},           {"type", grid.type},
      {"class", grid.grid_class},    {"active_voxels", grid.num_active_voxels},
      {"bounding_box", box},         {"voxel_size", {grid.voxel_size.x(), grid.voxel_size.y(), grid.voxel_size.z()}},
      {"is_linear", grid.is_linear}, {"metadata", json_of(grid.metadata)}};
}

Json json_of(const VdbDescription& description, const std::filesystem::path& file) {
  auto grids = Json::array();
  for (const GridDescription& grid : description.grids) grids.push_back(json_of(grid));
  return {{"file", file.string()}, {"is_map", false}, {"metadata", json_of(description.metadata)}, {"grids", grids}};
}

// What the map knows beside its voxels.
struct MapBackground {
  bool has_visibility = false;
  MapHistory history;
};

std::string text_of(const MapBackground& background) {
  std::string text = background.has_visibility ? "rays       kept: what is free is known\n"
                                               : "rays       none: what is not occupied was never seen\n";
  for (const MapEpoch& epoch : background.history.epochs) {
    text += fmt::format("epoch      {}{}\n", epoch.number, epoch.date.empty() ? "" : ", " + printable(epoch.date));
  }
  return text;
}

void add_background(Json& json, const MapBackground& background) {
  json["visibility"] = background.has_visibility;
  json["history"] = Json::array();
  for (const MapEpoch& epoch : background.history.epochs) {
    json["history"].push_back({{"epoch", epoch.number}, {"date", epoch.date.empty() ? Json() : Json(epoch.date)}});
  }
}

void tell_map(const VoxelMap& map, const std::filesystem::path& file, const CommonOptions& common) {
  const MapBackground background{has_visibility(file), load_history(file)};
  if (common.json) {
    Json json = json_of_map(map, file);
    add_background(json, background);
    print_json(json);
  } else {
    print_result(printable(file.string()) + ": a map of vdbmap\n" + text_of_map(map, file) + text_of(background));
  }
}

void tell_foreign(const VdbDescription& description, const std::filesystem::path& file, const CommonOptions& common) {
  if (common.json) {
    print_json(json_of(description, file));
  } else {
    print_result(text_of(description, file));
  }
}

ExitCode run_here(const InfoOptions& options, const CommonOptions& common) {
  if (is_map_file(options.file)) {
    tell_map(load_map(options.file), options.file, common);
  } else {
    tell_foreign(describe_vdb(options.file), options.file, common);
  }
  return ExitCode::kDone;
}

// The manifest tells all: no tile is opened.
void tell_city(const City& city, const std::filesystem::path& path, const CommonOptions& common) {
  if (common.json) {
    print_json(json_of_city(city.manifest, path));
  } else {
    print_result(printable(path.string()) + ": a city of vdbmap\n" + text_of_city(city.manifest));
  }
}

ExitCode run(const InfoOptions& options, const CommonOptions& common) {
  if (is_city(options.file)) {
    tell_city(open_city(options.file), options.file, common);
    return ExitCode::kDone;
  }
  return run_in_child(
      options.file, [&] { return run_here(options, common); }, ChildLimits::for_file(options.file));
}

}  // namespace

Command info_command() {
  return make_command<InfoOptions>("info", "Say what a map, a city, or a .vdb file of another program, holds",
                                   "vdbmap info map.vdb\n"
                                   "vdbmap info city/\n"
                                   "vdbmap info smoke.vdb --json",
                                   add_options, run);
}

}  // namespace vdbmap::cli
