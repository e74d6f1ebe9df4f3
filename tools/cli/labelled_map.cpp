// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/labelled_map.h"

#include <algorithm>

#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

void check_labels(const std::filesystem::path& path, bool has_labels, LabelScheme scheme) {
  if (!has_labels) throw IoError::malformed(path, "has no classes: make them with vdbmap segment");
  if (scheme == LabelScheme::kSemanticKitti) return;
  throw IoError::malformed(
      path, "its classes are " + std::string(text_of(scheme)) + ", expected semantickitti, as of vdbmap segment");
}

void check_labels(const std::filesystem::path& path, const VoxelMap& map) {
  const bool has_labels = !map.levels.empty() && map.finest().channels().labels.size() == map.finest().size();
  check_labels(path, has_labels, map.label_scheme);
}

}  // namespace

VoxelMap load_labelled_map(const std::filesystem::path& path) {
  VoxelMap map = load_map_or_city(path);
  check_labels(path, map);
  return map;
}

LoadedMap load_seen_labelled_map(const std::filesystem::path& path,
                                 const std::function<TileChoice(const MapFrame& frame)>& is_wanted) {
  if (!is_city(path)) {
    LoadedMap loaded = load_seen_map(path);
    check_labels(path, loaded.map);
    return loaded;
  }
  City city = open_city(path);
  const CityLayout& layout = city.manifest.layout;
  check_labels(path, std::ranges::count(layout.channels, "label") > 0, layout.label_scheme);
  return load_seen_window(city, is_wanted(layout.frame));
}

std::string date_of_map(const std::filesystem::path& path) {
  if (is_city(path)) return date_of(open_city(path).manifest);
  const MapHistory history = load_history(path);
  return history.epochs.empty() ? "" : history.epochs.back().date;
}

}  // namespace vdbmap::cli
