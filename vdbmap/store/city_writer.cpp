// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/vdb/map_file.h"
#include "vdbmap/io/vdb/vdb_checksum.h"

namespace vdbmap {
namespace {

using Path = std::filesystem::path;

// Names in the folder of a city; those of unfinished files go on with a dot and letters.
constexpr std::array<std::string_view, 7> kNames = {"map.json", "epochs", "tiles", "parts", "lock", "sums", "cache"};

bool is_ours(const std::string& name) {
  return std::ranges::any_of(kNames, [&](std::string_view ours) {
    return name.starts_with(ours) && (name.size() == ours.size() || name[ours.size()] == '.');
  });
}

std::vector<Path> list_folder_entries(const Path& folder) {
  std::vector<Path> entries;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    entries.push_back(entry->path());
  }
  if (error && error != std::errc::no_such_file_or_directory)
    throw IoError::system(folder, "cannot list", error.value());
  return entries;
}

void create_folder(const Path& folder) {
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw IoError::system(folder, "cannot create", error.value());
}

bool create_city_folder(const Path& folder) {
  std::error_code missing;
  if (std::filesystem::is_directory(folder, missing)) return false;
  create_folder(folder);
  return true;
}

// A folder of something else, somebody's home for example, gets no city.
void check_content(const Path& folder) {
  for (const Path& entry : list_folder_entries(folder)) {
    if (is_ours(entry.filename().string())) continue;
    throw IoError::malformed(folder, "is no city: it holds '" + entry.filename().string() + "'");
  }
}

void remove_with_content(const Path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) throw IoError::system(path, "cannot remove", error.value());
}

// "3_-12" of "3_-12.HASH.vdb" and of what is on its way to be one; empty for names of others.
bool may_be_tile(const std::string& name) {
  const std::string_view front = std::string_view(name).substr(0, name.find('.'));
  return front.size() >= 3 && front.find('_') != std::string_view::npos &&
         front.find_first_not_of("-_0123456789") == std::string_view::npos;
}

// The files that manifests name.
struct NamedFiles {
  std::set<std::string> tiles;
  std::set<std::string> parts;
};

NamedFiles named_files(const Path& folder) {
  NamedFiles names;
  for (const auto& [epoch, manifest] : read_epochs(folder)) {
    for (const CityTile& tile : manifest.tiles) names.tiles.insert(tile_path(folder, tile).filename().string());
    for (const CityPart& part : manifest.parts) names.parts.insert(kept_part_path(folder, part).filename().string());
  }
  return names;
}

// A part, or what is on its way to be one.
bool may_be_part(const std::string& name) { return name.find(".part") != std::string::npos; }

void sweep_parts(const Path& folder, const std::set<std::string>& named) {
  for (const Path& file : list_folder_entries(folder)) {
    const std::string name = file.filename().string();
    if (may_be_part(name) && !named.contains(name)) remove_with_content(file);
  }
  std::error_code error;
  if (named.empty()) std::filesystem::remove(folder, error);  // unless something else is in it
}

void copy_tile(const Path& from, const Path& to) {
  constexpr std::uint64_t kChunk = std::uint64_t{1} << 20;
  ByteReader source(from, ByteReader::Loading::kOnDemand);
  AtomicFile copy(to);
  while (source.remaining() > 0) {
    copy.write(source.bytes(std::min(kChunk, source.remaining())));
    source.forget_before(source.offset());
  }
  copy.commit();
}

// Keeps a manifest as that of its epoch.
void keep_manifest(const Path& folder, const CityManifest& manifest) {
  create_folder(epochs_path(folder));
  write_file(epoch_path(folder, manifest.epoch), text_of(manifest));
  sync_folder(epochs_path(folder));
}

}  // namespace

CityWriter::CityWriter(Path folder)
    : folder_(std::move(folder)), is_new_(create_city_folder(folder_)), lock_(std::nullopt) {
  if (!is_new_) check_content(folder_);
  lock_.emplace(folder_);
  const std::map<std::int32_t, CityManifest> epochs = read_epochs(folder_);
  num_epochs_ = epochs.size();
  std::error_code missing;
  if (std::filesystem::exists(manifest_path(folder_), missing)) current_ = open_city(folder_);
  sweep();
  create_folder(tiles_path(folder_));
}

CityWriter::~CityWriter() {
  if (is_published_) return;
  try {
    if (is_new_) {
      remove_with_content(folder_);
    } else {
      sweep();
    }
  } catch (const std::exception&) {  // the next writer sweeps
  }
}

void check_tile_file(const Path& path, const CityTile& tile) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw IoError::system(path, "cannot open", error.value());
  if (size == tile.num_bytes && stated_checksum(path) == tile.hash) return;
  throw IoError::malformed(path, "is not the tile that its name says");
}

CityTile save_tile(const Path& tiles_folder, const TileId& id, const VoxelMap& tile, float density,
                   const std::optional<Visibility>& visibility) {
  const Path unnamed = tiles_folder / (tile_name(id) + ".vdb");
  save_map(unnamed, tile, {visibility, {}}, {density});
  CityTile described = describe_tile(id, tile);
  described.has_rays = visibility.has_value();
  described.hash = *stated_checksum(unnamed);
  described.num_bytes = std::filesystem::file_size(unnamed);
  // A file of that name is the same already, or was damaged.
  const Path path = tiles_folder / tile_file_name(described);
  if (::rename(unnamed.c_str(), path.c_str()) != 0) throw IoError::system(path, "cannot create", errno);
  return described;
}

CityTile CityWriter::save_tile(const TileId& id, const VoxelMap& tile, float density,
                               const std::optional<Visibility>& visibility) const {
  return vdbmap::save_tile(tiles_path(folder_), id, tile, density, visibility);
}

void CityWriter::adopt_tile(const CityTile& tile, const Path& city) const {
  const Path from = tile_path(city, tile);
  check_tile_file(from, tile);
  const Path to = tile_path(folder_, tile);
  const Path unnamed = tiles_path(folder_) / (tile_name(tile.id) + ".link");
  ::unlink(unnamed.c_str());
  if (::link(from.c_str(), unnamed.c_str()) != 0) return copy_tile(from, to);
  // Where both are the same file already, this does nothing and leaves both names.
  if (::rename(unnamed.c_str(), to.c_str()) != 0) throw IoError::system(to, "cannot create", errno);
  ::unlink(unnamed.c_str());
}

CityPart CityWriter::save_part(const PartNotes& found, std::span<const TileId> ids, const PackedTile& packed) const {
  create_folder(kept_parts_path(folder_));
  const Path unnamed = kept_parts_path(folder_) / (found.source.hash + ".part.new");
  CityPart part{found.source.hash, write_part(unnamed, "city", found, ids, packed), 0};
  part.num_bytes = std::filesystem::file_size(unnamed);
  const Path path = kept_part_path(folder_, part);
  if (::rename(unnamed.c_str(), path.c_str()) != 0) throw IoError::system(path, "cannot create", errno);
  return part;
}

void CityWriter::publish(const CityManifest& manifest, std::size_t keep_epochs) {
  sync_folder(tiles_path(folder_));
  if (!manifest.parts.empty()) sync_folder(kept_parts_path(folder_));
  if (current_ && current_->manifest.epoch != manifest.epoch) keep_manifest(folder_, current_->manifest);
  write_file(manifest_path(folder_), text_of(manifest));
  is_published_ = true;
  sync_folder(folder_);
  std::vector<std::int32_t> epochs;
  for (const auto& [epoch, kept] : read_epochs(folder_)) epochs.push_back(epoch);
  for (std::size_t i = 0; i + std::max<std::size_t>(keep_epochs, 1) < epochs.size(); ++i) {
    remove_with_content(epoch_path(folder_, epochs[i]));
  }
  num_epochs_ = std::min(epochs.size(), std::max<std::size_t>(keep_epochs, 1));
  current_ = City{folder_, std::nullopt, manifest};
  sweep();
}

void CityWriter::sweep() const {
  // Kept by a writer that came no further: the manifest of that epoch is still the latest.
  if (current_) remove_with_content(epoch_path(folder_, current_->manifest.epoch));
  const NamedFiles named = named_files(folder_);
  sweep_parts(kept_parts_path(folder_), named.parts);
  for (const Path& file : list_folder_entries(tiles_path(folder_))) {
    const std::string name = file.filename().string();
    if (may_be_tile(name) && !named.tiles.contains(name)) remove_with_content(file);
  }
  for (const Path& file : list_folder_entries(cache_path(folder_))) {
    const std::string name = file.filename().string();
    const std::size_t hash_end = name.find('.', name.find('.') + 1);
    if (!named.tiles.contains(name.substr(0, hash_end) + ".vdb")) remove_with_content(file);
  }
  for (const Path& folder : {folder_, epochs_path(folder_)}) {
    for (const Path& file : list_folder_entries(folder)) {
      const std::string name = file.filename().string();
      const bool is_unfinished = name.starts_with("map.json.") || name.starts_with("sums.") ||
                                 (folder != folder_ && name.find(".json.") != std::string::npos);
      if (is_unfinished) remove_with_content(file);
    }
  }
}

}  // namespace vdbmap
