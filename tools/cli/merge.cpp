// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "tools/cli/city_output.h"
#include "tools/cli/city_summary.h"
#include "tools/cli/command.h"
#include "tools/cli/map_output.h"
#include "tools/cli/map_summary.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_merge.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/store/city_of_map.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {
namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> maps;
  MapOutput output;
};

void add_options(CLI::App& app, MergeOptions& options) {
  app.add_option("MAPS", options.maps, "Two or more maps or cities; the first one's anchor is kept")
      ->type_name("FILE")
      ->required();
  add_map_output(app, options.output, /*may_be_city=*/true);
}

// Maps that do not fit together are bad input, not wrong usage: the message names the file.
VoxelMap merge_next(const VoxelMap& merged, const VoxelMap& next, const std::filesystem::path& file) {
  try {
    return merge_maps(merged, next);
  } catch (const std::invalid_argument& error) {
    throw IoError::malformed(file, error.what());
  } catch (const std::out_of_range& error) {
    throw IoError::malformed(file, error.what());
  }
}

// Merged maps of which one did not say its scheme do not say theirs: so all schemes are compared, whatever the order.
void check_scheme(const VoxelMap& map, const std::filesystem::path& file, std::optional<LabelScheme>& known) {
  if (map.label_scheme == LabelScheme::kUnknown) return;
  if (known.value_or(map.label_scheme) != map.label_scheme) {
    throw IoError::malformed(
        file, fmt::format("has labels of {}, a map before it of {}", text_of(map.label_scheme), text_of(*known)));
  }
  known = map.label_scheme;
}

VoxelMap merge_files(const std::vector<std::filesystem::path>& files, const CommonOptions& common) {
  Progress progress("merging maps", files.size(), common);
  VoxelMap merged = load_map_or_city(files.front());
  std::optional<LabelScheme> known_scheme;
  check_scheme(merged, files.front(), known_scheme);
  progress.advance();
  for (std::size_t i = 1; i < files.size(); ++i) {
    const VoxelMap next = load_map_or_city(files[i]);
    check_scheme(next, files[i], known_scheme);
    merged = merge_next(merged, next, files[i]);
    progress.advance();
  }
  return merged;
}

// What the cities among the maps have counted. Of maps in one file that is not known.
std::vector<MapSource> sources_of(const std::vector<std::filesystem::path>& maps) {
  std::vector<MapSource> sources;
  for (const std::filesystem::path& map : maps) {
    if (!is_city(map)) continue;
    for (const MapSource& source : open_city(map).manifest.sources) {
      if (std::ranges::count(sources, source.hash, &MapSource::hash) > 0) {
        throw IoError::malformed(map, "has counted " + source.name + ", as has a city before it");
      }
      sources.push_back(source);
    }
  }
  std::ranges::sort(sources, {}, [](const MapSource& s) { return std::tie(s.epoch, s.name, s.hash); });
  return sources;
}

// What rays passed in one map, points of another may fill.
void warn_of_rays(const std::vector<std::filesystem::path>& maps) {
  for (const std::filesystem::path& map : maps) {
    if (!is_city(map) && has_visibility(map)) {
      spdlog::warn("{}: what its rays said is not in the merged map, use update to add to it", map.string());
    }
  }
}

void print_city(const CityManifest& manifest, const MergeOptions& options, const CommonOptions& common) {
  if (common.json) {
    print_json(json_of_city(manifest, options.output.file));
  } else {
    print_result(fmt::format("{}: merged from {} maps\n", options.output.file.string(), options.maps.size()) +
                 text_of_city(manifest));
  }
}

ExitCode run(const MergeOptions& options, const CommonOptions& common) {
  if (options.maps.size() < 2) throw std::invalid_argument("merge needs two maps or more");
  const bool makes_city = is_city_output(options.output.file);
  if (!makes_city) check_output(options.output.file, kMapKind, options.maps);
  const std::vector<MapSource> sources = sources_of(options.maps);
  const VoxelMap merged = merge_files(options.maps, common);
  warn_of_rays(options.maps);
  if (makes_city) {
    print_city(save_city(city_folder(options.output.file), merged, options.output.save, sources), options, common);
    return ExitCode::kDone;
  }
  save_map(options.output.file, merged, options.output.save);
  if (common.json) {
    print_json(json_of_map(merged, options.output.file));
  } else {
    print_result(fmt::format("{}: merged from {} maps\n", options.output.file.string(), options.maps.size()) +
                 text_of_map(merged, options.output.file));
  }
  return ExitCode::kDone;
}

}  // namespace

Command merge_command() {
  return make_command<MergeOptions>("merge", "Make one map of several, as if built from all their points",
                                    "vdbmap merge a.vdb b.vdb -o both.vdb\n"
                                    "vdbmap merge city/ b.vdb -o both/\n"
                                    "vdbmap merge monday.vdb tuesday.vdb friday.vdb -o week.vdb",
                                    add_options, run);
}

}  // namespace vdbmap::cli
