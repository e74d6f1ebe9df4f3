// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_manifest.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"
#include "vdbmap/store/content_hash.h"
#include "vdbmap/store/json_field.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormatName = "vdbmap city";
constexpr std::size_t kTileHashSize = 20;
constexpr std::size_t kSourceHashSize = 32;

Json json_of(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

// Without voxels there is no box, and JSON has no infinity.
Json json_of(const CityTile& tile) {
  const bool has_box = tile.extent.min.allFinite() && tile.extent.max.allFinite();
  Json json = {{"x", tile.id.x},
               {"y", tile.id.y},
               {"hash", tile.hash},
               {"bytes", tile.num_bytes},
               {"points", tile.num_points},
               {"voxels", tile.num_voxels},
               {"min", has_box ? json_of(tile.extent.min) : Json(nullptr)},
               {"max", has_box ? json_of(tile.extent.max) : Json(nullptr)}};
  if (tile.has_rays) json["rays"] = true;
  return json;
}

Json json_of(const MapEpoch& epoch) {
  const MapChanges& changes = epoch.changes;
  return {{"number", epoch.number},         {"date", epoch.date},           {"added", changes.added},
          {"confirmed", changes.confirmed}, {"replaced", changes.replaced}, {"gone", changes.gone},
          {"unseen", changes.unseen},       {"moved", changes.moved}};
}

Json json_of(const MapSource& source) {
  return {{"name", source.name}, {"hash", source.hash}, {"points", source.num_points}, {"epoch", source.epoch}};
}

Json json_of(const CityPart& part) { return {{"source", part.source}, {"hash", part.hash}, {"bytes", part.num_bytes}}; }

// A name need not be UTF-8, JSON must be: what is not becomes U+FFFD, and the hash still tells sources apart.
std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

template <typename Value>
std::string lines_of(const std::vector<Value>& values) {
  std::string text = "[";
  for (const Value& value : values) text += (&value == &values.front() ? "\n    " : ",\n    ") + dump(json_of(value));
  return text + (values.empty() ? "]" : "\n  ]");
}

void add_line(std::string& text, const char* key, const std::string& value) {
  text += std::string("  \"") + key + "\": " + value + ",\n";
}

MapFrame frame_of(const JsonField& field) {
  MapFrame frame{field.at("anchor").point(), std::nullopt};
  if (!is_anchor(frame.anchor)) field.at("anchor").fail("is no point of whole multiples of 64 m");
  if (!field.at("epsg").is_null()) frame.epsg = field.at("epsg").integer();
  return frame;
}

std::vector<double> voxel_sizes_of(const JsonField& field) {
  std::vector<double> sizes;
  for (const JsonField& element : field.elements()) {
    sizes.push_back(element.number());
    try {
      voxels_per_metre(sizes.back());
      if (sizes.size() > 1) level_factor(sizes[sizes.size() - 2], sizes.back());
    } catch (const std::invalid_argument& error) {
      element.fail(std::string("cannot be: ") + error.what());
    }
  }
  if (sizes.empty()) field.fail("is empty");
  return sizes;
}

std::vector<std::string> channels_of(const JsonField& field) {
  std::vector<std::string> given;
  for (const JsonField& element : field.elements()) given.push_back(element.text());
  std::vector<std::string> known;
  for_each_channel([&](const char* name, auto /*channel*/) {
    if (std::ranges::find(given, name) != given.end()) known.emplace_back(name);
  });
  if (given != known) field.fail("names something else than channels in their order");
  return known;
}

CityLayout layout_of(const JsonField& field) {
  CityLayout layout{frame_of(field), voxel_sizes_of(field.at("voxel_sizes")), field.at("has_color").truth(),
                    channels_of(field.at("channels"))};
  const std::optional<LabelScheme> scheme = label_scheme_of(field.at("label_scheme").text());
  if (!scheme) field.at("label_scheme").fail("is not known");
  layout.label_scheme = *scheme;
  layout.density = static_cast<float>(field.at("density").number());
  if (!(layout.density > 0)) field.at("density").fail("is not above 0");
  return layout;
}

CityTile tile_of(const JsonField& field, std::size_t num_levels) {
  CityTile tile;
  tile.id = {field.at("x").integer(), field.at("y").integer()};
  tile.hash = field.at("hash").hash(kTileHashSize);
  tile.num_bytes = field.at("bytes").count();
  tile.num_points = field.at("points").count();
  for (const JsonField& count : field.at("voxels").elements()) tile.num_voxels.push_back(count.count());
  if (field.has("rays")) tile.has_rays = field.at("rays").truth();
  const auto num_empty = static_cast<std::size_t>(std::ranges::count(tile.num_voxels, 0U));
  const bool may_be_empty = tile.has_rays && num_empty == num_levels;
  if (tile.num_voxels.size() != num_levels || (num_empty > 0 && !may_be_empty)) {
    field.at("voxels").fail("is no list of " + std::to_string(num_levels) + " numbers of voxels above 0");
  }
  if (num_empty == 0) tile.extent = {field.at("min").point(), field.at("max").point()};
  return tile;
}

MapEpoch epoch_of(const JsonField& field) {
  return {field.at("number").integer(),
          field.at("date").text(),
          {field.at("added").count(), field.at("confirmed").count(), field.at("replaced").count(),
           field.at("gone").count(), field.at("unseen").count(), field.at("moved").count()}};
}

MapSource source_of(const JsonField& field) {
  return {field.at("name").text(), field.at("hash").hash(kSourceHashSize), field.at("points").count(),
          field.at("epoch").integer()};
}

CityPart part_of(const JsonField& field, const std::set<std::string>& sources) {
  CityPart part;
  part.source = field.at("source").hash(kSourceHashSize);
  part.hash = field.at("hash").hash(ContentHash::kNumDigits);
  part.num_bytes = field.at("bytes").count();
  if (!sources.contains(part.source)) field.at("source").fail("is no source");
  return part;
}

}  // namespace

bool CityTile::operator==(const CityTile& other) const {
  return id == other.id && hash == other.hash && num_bytes == other.num_bytes && num_points == other.num_points &&
         num_voxels == other.num_voxels && extent.min == other.extent.min && extent.max == other.extent.max &&
         has_rays == other.has_rays;
}

bool has_rays(const CityManifest& manifest) {
  return std::ranges::count(manifest.tiles, true, &CityTile::has_rays) > 0;
}

std::string text_of(const CityManifest& manifest) {
  const CityLayout& layout = manifest.layout;
  std::string text = "{\n";
  add_line(text, "format", dump(kFormatName));
  const bool is_of_version_1 = manifest.epochs.empty() && !has_rays(manifest);
  add_line(text, "version", dump(is_of_version_1 ? 1 : kCityFormat));
  add_line(text, "epoch", dump(manifest.epoch));
  add_line(text, "anchor", dump(json_of(layout.frame.anchor)));
  add_line(text, "epsg", dump(layout.frame.epsg ? Json(*layout.frame.epsg) : Json(nullptr)));
  add_line(text, "tile_size", dump(kTileSize));
  add_line(text, "voxel_sizes", dump(layout.voxel_sizes));
  add_line(text, "has_color", dump(layout.has_color));
  add_line(text, "channels", dump(Json(layout.channels)));
  add_line(text, "label_scheme", dump(std::string(vdbmap::text_of(layout.label_scheme))));
  add_line(text, "density", dump(layout.density));
  if (!manifest.epochs.empty()) add_line(text, "epochs", lines_of(manifest.epochs));
  add_line(text, "tiles", lines_of(manifest.tiles));
  if (!manifest.parts.empty()) add_line(text, "parts", lines_of(manifest.parts));
  return text + "  \"sources\": " + lines_of(manifest.sources) + "\n}\n";
}

CityManifest parse_city_manifest(std::string_view text, const std::filesystem::path& path) {
  const Json json = parse_json(text, path);
  const JsonField root(json, "", path);
  root.check_format(kFormatName, 1, kCityFormat);
  CityManifest manifest;
  manifest.epoch = root.at("epoch").integer();
  if (manifest.epoch < 0) root.at("epoch").fail("is below 0");
  if (root.at("tile_size").number() != kTileSize) root.at("tile_size").fail("is not 64");
  manifest.layout = layout_of(root);
  for (const JsonField& field : root.at("tiles").elements()) {
    manifest.tiles.push_back(tile_of(field, manifest.layout.voxel_sizes.size()));
    const std::size_t count = manifest.tiles.size();
    if (count > 1 && !(manifest.tiles[count - 2].id < manifest.tiles[count - 1].id)) field.fail("is out of order");
  }
  for (const JsonField& field : root.at("sources").elements()) manifest.sources.push_back(source_of(field));
  if (root.has("epochs")) {
    for (const JsonField& field : root.at("epochs").elements()) manifest.epochs.push_back(epoch_of(field));
  }
  if (!root.has("parts")) return manifest;
  std::set<std::string> sources;
  for (const MapSource& source : manifest.sources) sources.insert(source.hash);
  for (const JsonField& field : root.at("parts").elements()) {
    manifest.parts.push_back(part_of(field, sources));
    const std::size_t count = manifest.parts.size();
    if (count > 1 && manifest.parts[count - 2].source >= manifest.parts[count - 1].source) {
      field.fail("is out of order");
    }
  }
  return manifest;
}

std::vector<double> exact_voxel_sizes(std::vector<double> voxel_sizes) {
  for (double& size : voxel_sizes) size = kTileSize / voxels_per_tile(size);
  return voxel_sizes;
}

std::vector<std::string> channel_names(const VoxelMap& map) {
  std::vector<std::string> names;
  for_each_channel([&](const char* name, auto channel) {
    if (!(map.finest().channels().*channel).empty()) names.emplace_back(name);
  });
  return names;
}

CityLayout layout_of(const VoxelMap& map, float density) {
  CityLayout layout;
  layout.frame = map.frame;
  for (const VoxelLevel& level : map.levels) layout.voxel_sizes.push_back(level.voxel_size());
  layout.voxel_sizes = exact_voxel_sizes(layout.voxel_sizes);
  layout.has_color = map.has_color;
  layout.channels = channel_names(map);
  layout.label_scheme = map.label_scheme;
  layout.density = density;
  return layout;
}

CityTile describe_tile(const TileId& id, const VoxelMap& tile) {
  CityTile described;
  described.id = id;
  described.num_points = num_points(tile.finest());
  for (const VoxelLevel& level : tile.levels) described.num_voxels.push_back(level.size());
  if (const std::optional<Extent> box = extent(tile)) described.extent = *box;
  return described;
}

const CityTile* find_tile(const CityManifest& manifest, const TileId& id) {
  const auto found = std::ranges::lower_bound(manifest.tiles, id, {}, &CityTile::id);
  return found == manifest.tiles.end() || found->id != id ? nullptr : &*found;
}

const MapEpoch* find_epoch(const CityManifest& manifest, std::int32_t number) {
  const auto found = std::ranges::lower_bound(manifest.epochs, number, {}, &MapEpoch::number);
  return found == manifest.epochs.end() || found->number != number ? nullptr : &*found;
}

std::string date_of(const CityManifest& manifest) {
  const MapEpoch* epoch = find_epoch(manifest, manifest.epoch);
  return epoch ? epoch->date : "";
}

const CityPart* find_part(const CityManifest& manifest, const std::string& source) {
  const auto found = std::ranges::lower_bound(manifest.parts, source, {}, &CityPart::source);
  return found == manifest.parts.end() || found->source != source ? nullptr : &*found;
}

std::optional<Extent> extent(const CityManifest& manifest) {
  if (manifest.tiles.empty()) return std::nullopt;
  Extent box = manifest.tiles.front().extent;
  for (const CityTile& tile : manifest.tiles) {
    box.min = box.min.cwiseMin(tile.extent.min);
    box.max = box.max.cwiseMax(tile.extent.max);
  }
  return box;
}

bool keeps_parts(const CityManifest& manifest) {
  return !manifest.parts.empty() && manifest.parts.size() == manifest.sources.size();
}

std::uint64_t num_points(const CityManifest& manifest) {
  std::uint64_t count = 0;
  for (const CityTile& tile : manifest.tiles) count += tile.num_points;
  return count;
}

std::vector<std::uint64_t> num_voxels(const CityManifest& manifest) {
  std::vector<std::uint64_t> counts(manifest.layout.voxel_sizes.size(), 0);
  for (const CityTile& tile : manifest.tiles) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += tile.num_voxels[i];
  }
  return counts;
}

}  // namespace vdbmap
