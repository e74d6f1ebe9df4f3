// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
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
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

struct LogOptions {
  std::filesystem::path city;
};

void add_options(CLI::App& app, LogOptions& options) {
  app.add_option("MAP", options.city, "A city, the folder that build made, or a map (.vdb)")
      ->type_name("FILE|FOLDER")
      ->required();
}

std::string text_of(const MapChanges& changes) {
  return fmt::format("  added {}, gone {}, replaced {}, confirmed {}, unseen {} voxels; {} left out that moved\n",
                     changes.added, changes.gone, changes.replaced, changes.confirmed, changes.unseen, changes.moved);
}

nlohmann::ordered_json json_of(const MapChanges& changes) {
  return {{"added", changes.added},         {"gone", changes.gone},     {"replaced", changes.replaced},
          {"confirmed", changes.confirmed}, {"unseen", changes.unseen}, {"moved", changes.moved}};
}

// A city in one epoch.
struct LogRow {
  std::int32_t epoch;
  const CityManifest& manifest;
  std::size_t num_new_tiles = 0;  // whose files no earlier epoch has
  std::size_t num_new_sources = 0;
  MapEpoch told = {};  // of the survey or drive: its date, and what it changed, where that is known
};

LogRow row_of(std::int32_t epoch, const CityManifest& manifest, std::set<std::string>& known_tiles) {
  LogRow row{epoch, manifest};
  if (const MapEpoch* told = find_epoch(manifest, epoch)) row.told = *told;
  for (const CityTile& tile : manifest.tiles) {
    row.num_new_tiles += known_tiles.insert(tile_name(tile.id) + tile.hash).second ? 1 : 0;
  }
  for (const MapSource& source : manifest.sources) row.num_new_sources += source.epoch == epoch ? 1 : 0;
  return row;
}

std::string text_of(const LogRow& row) {
  std::string text = fmt::format("epoch {}{}: {} points, {} voxels in {} tiles ({} of them new), {} sources\n",
                                 row.epoch, row.told.date.empty() ? "" : " (" + printable(row.told.date) + ")",
                                 num_points(row.manifest), num_voxels(row.manifest).front(), row.manifest.tiles.size(),
                                 row.num_new_tiles, row.manifest.sources.size());
  if (row.told.changes != MapChanges()) {
    return text + text_of(row.told.changes) + fmt::format("  from {} scans\n", row.num_new_sources);
  }
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
          {"date", row.told.date.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(row.told.date)},
          {"changes", json_of(row.told.changes)},
          {"points", num_points(row.manifest)},
          {"voxels", num_voxels(row.manifest)},
          {"tiles", row.manifest.tiles.size()},
          {"new_tiles", row.num_new_tiles},
          {"sources", row.manifest.sources.size()},
          {"new_sources", sources}};
}

std::string text_of(const MapHistory& history, const MapEpoch& epoch) {
  std::string text = fmt::format("epoch {}{}: {} sources\n", epoch.number,
                                 epoch.date.empty() ? "" : " (" + printable(epoch.date) + ")",
                                 std::ranges::count(history.sources, epoch.number, &MapSource::epoch));
  return epoch.changes == MapChanges() ? text : text + text_of(epoch.changes);
}

nlohmann::ordered_json json_of(const MapHistory& history, const MapEpoch& epoch) {
  auto sources = nlohmann::ordered_json::array();
  for (const MapSource& source : history.sources) {
    if (source.epoch == epoch.number) sources.push_back({{"name", source.name}, {"hash", source.hash}});
  }
  return {{"epoch", epoch.number},
          {"date", epoch.date.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(epoch.date)},
          {"changes", json_of(epoch.changes)},
          {"new_sources", sources}};
}

ExitCode run_file(const LogOptions& options, const CommonOptions& common) {
  const MapHistory history = load_history(options.city);
  std::string text;
  auto json = nlohmann::ordered_json::array();
  for (const MapEpoch& epoch : history.epochs) {
    text += text_of(history, epoch);
    json.push_back(json_of(history, epoch));
  }
  if (common.json) {
    print_json(json);
  } else {
    print_result(text.empty() ? options.city.string() + ": does not say from what it was made\n" : text);
  }
  return ExitCode::kDone;
}

ExitCode run(const LogOptions& options, const CommonOptions& common) {
  if (!is_city(options.city)) return run_file(options, common);
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
  return make_command<LogOptions>("log", "List the epochs of a city or a map and what each changed",
                                  "vdbmap log city/\n"
                                  "vdbmap log map2.vdb --json",
                                  add_options, run);
}

}  // namespace vdbmap::cli
