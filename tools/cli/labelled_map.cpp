// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/labelled_map.h"

#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/visibility_file.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap::cli {

VoxelMap load_labelled_map(const std::filesystem::path& path) {
  VoxelMap map = load_map_or_city(path);
  if (map.levels.empty() || map.finest().channels().labels.size() != map.finest().size()) {
    throw IoError::malformed(path, "has no classes: make them with vdbmap segment");
  }
  if (map.label_scheme != LabelScheme::kSemanticKitti) {
    throw IoError::malformed(path, "its classes are " + std::string(text_of(map.label_scheme)) +
                                       ", expected semantickitti, as of vdbmap segment");
  }
  return map;
}

std::optional<Visibility> visibility_of(const std::filesystem::path& path, const VoxelMap& map) {
  return is_city(path) ? std::nullopt : load_visibility(path, map);
}

std::string date_of_map(const std::filesystem::path& path) {
  if (is_city(path)) return "";
  const MapHistory history = load_history(path);
  return history.epochs.empty() ? "" : history.epochs.back().date;
}

}  // namespace vdbmap::cli
