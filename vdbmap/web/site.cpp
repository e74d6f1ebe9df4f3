// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site.h"

#include <algorithm>
#include <bitset>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"
#include "vdbmap/core/voxel_map.h"
#include "vdbmap/io/vdb/diff_file.h"
#include "vdbmap/render/label_colors.h"
#include "vdbmap/store/city_folder.h"
#include "vdbmap/web/change_marks.h"
#include "vdbmap/web/label_code.h"
#include "vdbmap/web/site_folder.h"
#include "vdbmap/web/site_placement.h"
#include "vdbmap/web/site_source.h"
#include "vdbmap/web/site_spaces.h"
#include "vdbmap/web/site_tiles.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSpacesFile = "spaces.json";

// An epoch that was written.
struct EpochWritten {
  std::string id;
  std::string name;
  std::string tileset;  // file of it
  SiteTiles tiles;
  bool has_age;
  bool has_label;
  bool has_color;
};

// What all epochs of a site must agree on.
struct SiteFrame {
  MapFrame frame;
  SiteGrid grid;
  LabelScheme label_scheme;
};

SiteFrame frame_of(const SiteSource& source) {
  return {source.layout().frame, site_grid(source.voxel_size()), source.layout().label_scheme};
}

void check_alike(const SiteFrame& site, const SiteSource& source, const SiteSource& first) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(source.path().string() + " has another " + what + " than " + first.path().string() +
                                ": they cannot be epochs of one site");
  };
  const CityLayout& layout = source.layout();
  if (layout.frame.anchor != site.frame.anchor) refuse("anchor");
  if (layout.frame.epsg != site.frame.epsg) refuse("EPSG code");
  if (source.voxel_size() != site.grid.finest_voxel_size) refuse("voxel size");
  if (layout.label_scheme != site.label_scheme && source.has_channel("label") && first.has_channel("label")) {
    refuse("label scheme");
  }
}

// "2023-09-01" or "2023-09" say a day; other names none.
std::optional<std::string> date_of(const std::string& name) {
  const auto matches = [&](const std::string& pattern) {
    if (name.size() != pattern.size()) return false;
    for (std::size_t i = 0; i < name.size(); ++i) {
      const bool is_digit = name[i] >= '0' && name[i] <= '9';
      if (pattern[i] == '0' ? !is_digit : name[i] != pattern[i]) return false;
    }
    return true;
  };
  if (matches("0000-00-00")) return name;
  if (matches("0000-00")) return name + "-01";
  return std::nullopt;
}

Json json_of(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

Json json_of(const EpochWritten& epoch) {
  std::uint64_t drawn = 0;
  for (const auto& [tile, file] : epoch.tiles.files) drawn += tile.level == 0 ? file.num_points : 0;
  const std::optional<std::string> date = date_of(epoch.name);
  return {{"id", epoch.id},
          {"name", epoch.name},
          {"date", date ? Json(*date) : Json()},
          {"tileset", epoch.tileset},
          {"voxels", epoch.tiles.num_voxels},
          {"drawn_voxels", drawn},
          {"points", epoch.tiles.num_points}};
}

Json labels_json(const std::vector<EpochWritten>& epochs, LabelScheme scheme) {
  std::bitset<256> codes;
  for (const EpochWritten& epoch : epochs) codes |= epoch.has_label ? epoch.tiles.label_codes : std::bitset<256>();
  Json labels = Json::array();
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!codes[i]) continue;
    const auto code = static_cast<LabelCode>(i);
    const std::optional<std::int32_t> label = label_of_code(scheme, code);
    const Rgb8 color = label_color(scheme, label.value_or(code));
    labels.push_back({{"code", code},
                      {"value", label ? Json(*label) : Json()},
                      {"name", label ? label_name(scheme, *label) : "other class"},
                      {"color", {color.r, color.g, color.b}}});
  }
  return labels;
}

openvdb::CoordBBox voxels_of(const std::vector<EpochWritten>& epochs) {
  openvdb::CoordBBox voxels;
  for (const EpochWritten& epoch : epochs) voxels.expand(epoch.tiles.voxels);
  return voxels;
}

Eigen::AlignedBox3d bounds_of(const std::vector<EpochWritten>& epochs, double voxel_size) {
  const openvdb::CoordBBox voxels = voxels_of(epochs);
  return {corner_of_voxel(voxels.min(), voxel_size), corner_of_voxel(voxels.max().offsetBy(1), voxel_size)};
}

Json numbers_of(const Eigen::Affine3d& transform) {
  Json numbers = Json::array();
  for (Eigen::Index i = 0; i < 16; ++i) numbers.push_back(transform.matrix().data()[i]);
  return numbers;
}

template <typename Member>
bool any_has(const std::vector<EpochWritten>& epochs, Member member) {
  for (const EpochWritten& epoch : epochs) {
    if (epoch.*member) return true;
  }
  return false;
}

std::string site_json(const SiteFrame& site, const std::vector<EpochWritten>& epochs, const SitePlacement& placement,
                      const SiteOptions& options) {
  const Eigen::AlignedBox3d bounds = bounds_of(epochs, site.grid.finest_voxel_size);
  std::int32_t num_levels = 0;
  for (const EpochWritten& epoch : epochs) num_levels = std::max(num_levels, epoch.tiles.num_levels);
  Json levels = Json::array();
  for (std::int32_t level = 0; level < num_levels; ++level) levels.push_back(site.grid.voxel_size(level));
  Json list = Json::array();
  for (const EpochWritten& epoch : epochs) list.push_back(json_of(epoch));

  const Json json = {
      {"format", "vdbmap-site"},
      {"version", 1},
      {"name", options.name},
      {"epsg", site.frame.epsg ? Json(*site.frame.epsg) : Json()},
      {"anchor", json_of(site.frame.anchor)},
      {"bounds", {{"min", json_of(bounds.min())}, {"max", json_of(bounds.max())}}},
      {"voxel_size", site.grid.finest_voxel_size},
      {"levels", levels},
      {"local_from_ecef", numbers_of(placement.world_from_local(bounds).inverse())},
      {"geoid_offset", options.geoid_offset},
      {"epochs", list},
      {"attributes",
       {{"color", any_has(epochs, &EpochWritten::has_color)},
        {"label", any_has(epochs, &EpochWritten::has_label)},
        {"change", !options.diff.empty()},
        {"epoch", any_has(epochs, &EpochWritten::has_age)}}},
      {"label_scheme", text_of(site.label_scheme)},
      {"labels", labels_json(epochs, site.label_scheme)},
      {"spaces", options.spaces.empty() ? Json() : Json(kSpacesFile)},
      {"attribution", nullptr},
  };
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Marks of a diff of maps like those of the site.
std::optional<VoxelLevel> load_marks(const SiteFrame& site, const SiteOptions& options) {
  if (options.diff.empty()) return std::nullopt;
  const MapDiff diff = load_diff(options.diff);
  if (diff.frame != site.frame || diff.voxel_size() != site.grid.finest_voxel_size) {
    throw IoError::malformed(options.diff, "is of maps with another anchor, EPSG code or voxel size");
  }
  return change_marks(diff);
}

EpochWritten write_epoch(const SiteSource& source, const SiteChanges& changes, const std::string& id,
                         const SiteEpoch& epoch, SiteFolder& folder, const SitePlacement& placement,
                         const SiteOptions& options) {
  EpochWritten written{id,
                       epoch.name.empty() ? id : epoch.name,
                       "tileset_" + id + ".json",
                       write_tiles(source, changes, folder, options.on_block_done),
                       source.has_channel("last_epoch"),
                       source.has_channel("label"),
                       source.layout().has_color};
  const SiteGrid grid = site_grid(source.voxel_size());
  for (const TilesetFile& file : tileset_of(written.tiles.files, grid, placement, id)) {
    folder.put(file.name, file.json);
  }
  return written;
}

// Further epochs of the last map, as many as there are more files of spaces than maps.
void add_epochs_of_spaces(std::vector<EpochWritten>& epochs, std::size_t num_files) {
  while (epochs.size() < num_files) {
    epochs.push_back(epochs.back());
    epochs.back().id = epochs.back().name = std::to_string(epochs.size());
  }
}

void check_names(const std::vector<std::string>& names, std::size_t num_epochs) {
  if (names.empty() || names.size() == num_epochs) return;
  throw std::invalid_argument(std::to_string(names.size()) + " names for " + std::to_string(num_epochs) + " epochs");
}

std::size_t write_spaces(const SiteFrame& site, std::vector<EpochWritten>& epochs, const SiteOptions& options,
                         const SiteFolder& folder) {
  if (options.spaces.empty()) return 0;
  const SpacesPlace place{site.frame, options.geoid_offset, bounds_of(epochs, site.grid.finest_voxel_size)};
  add_epochs_of_spaces(epochs, options.spaces.size());
  std::vector<std::pair<std::string, EpochSpaces>> spaces;
  std::set<std::string> ids;
  for (std::size_t i = 0; i < options.spaces.size(); ++i) {
    const EpochWritten& epoch = epochs[epochs.size() - options.spaces.size() + i];
    spaces.emplace_back(epoch.id, read_site_spaces(options.spaces[i], place));
    for (const SiteSpace& space : spaces.back().second.spaces) ids.insert(space.id);
    const std::string& date = spaces.back().second.date;
    if (!date.empty()) epochs[epochs.size() - options.spaces.size() + i].name = date;
  }
  folder.put(kSpacesFile, spaces_json(spaces));
  return ids.size();
}

SiteWritten summary_of(const std::vector<EpochWritten>& epochs, const SiteFolder& folder) {
  SiteWritten summary;
  for (const EpochWritten& epoch : epochs) {
    summary.num_voxels += epoch.tiles.num_voxels;
    summary.num_tiles += epoch.tiles.files.size();
    for (const auto& [tile, file] : epoch.tiles.files) {
      summary.num_tile_bytes += file.num_bytes;
      if (tile.level == 0) summary.num_drawn += file.num_points;
    }
  }
  summary.num_files_written = folder.num_written();
  summary.num_files_kept = folder.num_kept();
  return summary;
}

}  // namespace

SiteWritten write_site(const std::filesystem::path& folder, const std::vector<SiteEpoch>& epochs,
                       const SiteOptions& options) {
  if (epochs.empty()) throw std::invalid_argument("a site needs a map");
  std::vector<SiteSource> sources;
  for (const SiteEpoch& epoch : epochs) sources.emplace_back(epoch.map);
  check_names(options.epoch_names, std::max(epochs.size(), options.spaces.size()));
  const SiteFrame site = frame_of(sources.front());
  for (const SiteSource& source : sources) check_alike(site, source, sources.front());
  const SitePlacement placement(site.frame, options.geoid_offset);
  const std::optional<VoxelLevel> marks = load_marks(site, options);
  std::size_t blocks = 0;
  for (const SiteSource& source : sources) blocks += num_blocks(source);

  SiteFolder output(folder);
  options.on_tiles_begun(blocks);
  std::vector<EpochWritten> written;
  for (std::size_t i = 0; i < epochs.size(); ++i) {
    SiteChanges changes;
    if (marks && i + 1 == epochs.size()) changes = {&*marks, i > 0 ? &sources[i - 1] : nullptr};
    written.push_back(write_epoch(sources[i], changes, std::to_string(i + 1), epochs[i], output, placement, options));
  }
  if (!options.page.empty()) output.put_folder(options.page);
  SiteWritten summary = summary_of(written, output);
  summary.is_on_globe = placement.is_on_globe();
  summary.num_spaces = write_spaces(site, written, options, output);
  for (std::size_t i = 0; i < options.epoch_names.size(); ++i) written[i].name = options.epoch_names[i];
  output.put(kSiteFile, site_json(site, written, placement, options));
  output.commit();
  return summary;
}

std::vector<std::filesystem::path> epochs_of(const std::filesystem::path& path) {
  if (!is_city(path)) return {path};
  const City city = open_city(path);
  if (city.epoch) return {path};
  std::vector<std::filesystem::path> paths;
  for (const std::int32_t epoch : list_epochs(city.folder)) {
    paths.push_back(city.folder.string() + "@" + std::to_string(epoch));
  }
  paths.push_back(path);
  return paths;
}

}  // namespace vdbmap
