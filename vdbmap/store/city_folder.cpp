// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_folder.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/store/content_hash.h"

namespace vdbmap {
namespace {

bool is_folder(const std::filesystem::path& path) {
  std::error_code missing;
  return std::filesystem::is_directory(path, missing);
}

bool is_there(const std::filesystem::path& path) {
  std::error_code missing;
  return std::filesystem::exists(path, missing);
}

std::optional<std::int32_t> parse_epoch(std::string_view digits) {
  std::int32_t epoch = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), epoch);
  const bool is_whole = error == std::errc() && end == digits.data() + digits.size() && epoch >= 0;
  return is_whole ? std::optional(epoch) : std::nullopt;
}

// "city@1" in parts, where there is such a folder.
struct EpochOfFolder {
  std::filesystem::path folder;
  std::int32_t epoch;
};

std::optional<EpochOfFolder> split_epoch(const std::filesystem::path& path) {
  const std::string& text = path.native();
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0) return std::nullopt;
  const std::optional<std::int32_t> epoch = parse_epoch(std::string_view(text).substr(at + 1));
  const std::filesystem::path folder = text.substr(0, at);
  if (!epoch || !is_folder(folder)) return std::nullopt;
  return EpochOfFolder{folder, *epoch};
}

CityManifest read_manifest(const std::filesystem::path& path) {
  ByteReader file(path);
  return parse_city_manifest(file.bytes(file.size()), path);
}

CityManifest read_latest(const std::filesystem::path& folder) {
  if (!is_there(manifest_path(folder))) throw IoError::malformed(folder, "is no city: it has no map.json");
  return read_manifest(manifest_path(folder));
}

CityManifest read_epoch(const std::filesystem::path& folder, std::int32_t epoch) {
  CityManifest latest = read_latest(folder);
  if (latest.epoch == epoch) return latest;
  if (!is_there(epoch_path(folder, epoch))) {
    throw IoError::malformed(
        folder, "keeps no epoch " + std::to_string(epoch) + ", its latest is " + std::to_string(latest.epoch));
  }
  return read_manifest(epoch_path(folder, epoch));
}

CityManifest read_manifest_of(const City& city) {
  return city.epoch ? read_epoch(city.folder, *city.epoch) : read_latest(city.folder);
}

}  // namespace

std::filesystem::path manifest_path(const std::filesystem::path& folder) { return folder / "map.json"; }
std::filesystem::path epochs_path(const std::filesystem::path& folder) { return folder / "epochs"; }
std::filesystem::path epoch_path(const std::filesystem::path& folder, std::int32_t epoch) {
  return epochs_path(folder) / (std::to_string(epoch) + ".json");
}
std::filesystem::path tiles_path(const std::filesystem::path& folder) { return folder / "tiles"; }

std::filesystem::path cache_path(const std::filesystem::path& folder) { return folder / "cache"; }

std::filesystem::path kept_parts_path(const std::filesystem::path& folder) { return folder / "parts"; }

std::filesystem::path kept_part_path(const std::filesystem::path& folder, const CityPart& part) {
  return kept_parts_path(folder) / (part.hash + ".part");
}

std::filesystem::path tile_path(const std::filesystem::path& folder, const CityTile& tile) {
  return tiles_path(folder) / tile_file_name(tile);
}

std::string tile_name(const TileId& tile) { return std::to_string(tile.x) + "_" + std::to_string(tile.y); }

std::string tile_file_name(const CityTile& tile) { return tile_name(tile.id) + "." + tile.hash + ".vdb"; }

std::string city_state(const std::filesystem::path& folder) {
  return is_there(manifest_path(folder)) ? hash_of_file(manifest_path(folder)) : "";
}

bool is_city(const std::filesystem::path& path) {
  return is_folder(path) || (!is_there(path) && split_epoch(path).has_value());
}

City open_city(const std::filesystem::path& path) {
  City city{path, std::nullopt, {}};
  if (!is_folder(path)) {
    const std::optional<EpochOfFolder> epoch = split_epoch(path);
    if (!epoch) throw IoError::system(path, "cannot open", ENOENT);
    city = {epoch->folder, epoch->epoch, {}};
  }
  city.manifest = read_manifest_of(city);
  return city;
}

bool reopen(City& city) {
  CityManifest now = read_manifest_of(city);
  const bool is_other = !(now == city.manifest);
  city.manifest = std::move(now);
  return is_other;
}

std::vector<std::int32_t> list_epochs(const std::filesystem::path& folder) {
  std::vector<std::int32_t> epochs;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(epochs_path(folder), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::optional<std::int32_t> epoch = parse_epoch(entry->path().stem().native());
    if (entry->path().extension() == ".json" && epoch) epochs.push_back(*epoch);
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw IoError::system(epochs_path(folder), "cannot list", error.value());
  }
  std::ranges::sort(epochs);
  return epochs;
}

std::map<std::int32_t, CityManifest> read_epochs(const std::filesystem::path& folder) {
  std::map<std::int32_t, CityManifest> epochs;
  for (const std::int32_t epoch : list_epochs(folder)) epochs[epoch] = read_manifest(epoch_path(folder, epoch));
  if (is_there(manifest_path(folder))) {
    CityManifest latest = read_latest(folder);
    epochs[latest.epoch] = std::move(latest);
  }
  return epochs;
}

}  // namespace vdbmap
