// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

struct LogOptions {
  std::filesystem::path city;
};

void add_options(CLI::App& app, LogOptions& options) {
  app.add_option("CITY", options.city, "A city, the folder that build made")->type_name("FOLDER")->required();
}

// A city in one epoch.
struct LogRow {
  std::int32_t epoch;
  const CityManifest& manifest;
  std::size_t num_new_tiles = 0;  // whose files no earlier epoch has
  std::size_t num_new_sources = 0;
};

LogRow row_of(std::int32_t epoch, const CityManifest& manifest, std::set<std::string>& known_tiles) {
  LogRow row{epoch, manifest};
  for (const CityTile& tile : manifest.tiles) {
    row.num_new_tiles += known_tiles.insert(tile_name(tile.id) + tile.hash).second ? 1 : 0;
  }
  for (const MapSource& source : manifest.sources) row.num_new_sources += source.epoch == epoch ? 1 : 0;
  return row;
}

std::string text_of(const LogRow& row) {
  std::string text = fmt::format("epoch {}: {} points, {} voxels in {} tiles ({} of them new), {} sources\n", row.epoch,
                                 num_points(row.manifest), num_voxels(row.manifest).front(), row.manifest.tiles.size(),
                                 row.num_new_tiles, row.manifest.sources.size());
  for (const MapSource& source : row.manifest.sources) {
    if (source.epoch != row.epoch) continue;
    text += fmt::format("  {}: {} points\n", printable(source.name), source.num_points);
  }
  return text;
}

nlohmann::ordered_json json_of(const LogRow& row) {
  auto sources = nlohmann::ordered_json::array();
  for (const MapSource& source : row.manifest.sources) {
    if (source.epoch != row.epoch) continue;
    sources.push_back({{"name", source.name}, {"hash", source.hash}, {"points", source.num_points}});
  }
  return {{"epoch", row.epoch},
          {"points", num_points(row.manifest)},
          {"voxels", num_voxels(row.manifest)},
          {"tiles", row.manifest.tiles.size()},
          {"new_tiles", row.num_new_tiles},
          {"sources", row.manifest.sources.size()},
          {"new_sources", sources}};
}

ExitCode run(const LogOptions& options, const CommonOptions& common) {
  open_city(options.city);  // says what is wrong with a folder that is no city
  const std::map<std::int32_t, CityManifest> epochs = read_epochs(options.city);
  std::set<std::string> known_tiles;
  std::string text;
  auto json = nlohmann::ordered_json::array();
  for (const auto& [epoch, manifest] : epochs) {
    const LogRow row = row_of(epoch, manifest, known_tiles);
    text += text_of(row);
    json.push_back(json_of(row));
  }
  if (common.json) {
    print_json(json);
  } else {
    print_result(text);
  }
  return ExitCode::kDone;
}

}  // namespace

Command log_command() {
  return make_command<LogOptions>("log", "List the epochs of a city and what was added in each",
                                  "vdbmap log city/\n"
                                  "vdbmap log city/ --json",
                                  add_options, run);
}

}  // namespace vdbmap::cli
