// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/tile_cache.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

// At the front of every file, in the machine's own order of bytes: another machine's is stale.
struct Header {
  std::uint64_t key;
  std::uint64_t checksum;  // of what follows
};

std::uint64_t hash_of(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

const CityTile* find_sorted(std::span<const CityTile> tiles, const TileId& id) {
  const auto found = std::ranges::lower_bound(tiles, id, {}, &CityTile::id);
  return found != tiles.end() && found->id == id ? &*found : nullptr;
}

}  // namespace

std::optional<std::uint64_t> neighborhood_hash(const CityManifest& manifest, std::span<const CityTile> tiles,
                                               const CityTile& tile) {
  std::string hashes;
  for (int i = 0; i < 9; ++i) {
    const TileId id = {tile.id.x + i / 3 - 1, tile.id.y + i % 3 - 1};
    const CityTile* neighbor = find_sorted(tiles, id);
    if (!neighbor && find_tile(manifest, id)) return std::nullopt;
    hashes += (neighbor ? neighbor->hash : "none") + ".";
  }
  return hash_of(hashes);
}

TileCache::TileCache(const std::filesystem::path& city_folder, std::string name)
    : folder_(cache_path(city_folder)), name_(std::move(name)) {}

std::filesystem::path TileCache::path_of(const CityTile& tile) const {
  return folder_ / (tile_name(tile.id) + "." + tile.hash + "." + name_);
}

std::optional<std::string> TileCache::read(const CityTile& tile, std::uint64_t key) const {
  try {
    ByteReader file(path_of(tile));
    Header header;
    std::memcpy(&header, file.bytes(sizeof(header)).data(), sizeof(header));
    const std::string_view bytes = file.bytes(file.remaining());
    if (header.key != key || header.checksum != hash_of(bytes)) return std::nullopt;
    return std::string(bytes);
  } catch (const IoError&) {
    return std::nullopt;
  }
}

// Under a name of this process's own first, so that no reader sees half of it. Not flushed: damage is seen.
void TileCache::write(const CityTile& tile, std::uint64_t key, std::string_view bytes) const {
  std::error_code error;
  std::filesystem::create_directory(folder_, error);
  const std::filesystem::path path = path_of(tile);
  const std::filesystem::path unfinished = path.native() + "." + std::to_string(::getpid());
  const Header header{key, hash_of(bytes)};
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&header), sizeof(header));
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) std::filesystem::rename(unfinished, path, error);
  if (!file || error) std::filesystem::remove(unfinished, error);
}

}  // namespace vdbmap
