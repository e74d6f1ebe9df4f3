// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/reduce_stage.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/atomic_folder.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/stages/finish_stage.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/tile_renewal.h"

namespace vdbmap {
namespace {

// Says for which plan a bucket was made.
std::filesystem::path key_path(const std::filesystem::path& bucket) { return bucket / "plan"; }

TilesOfParts tiles_of_bucket(const Job& job, std::size_t bucket, const CountedParts& counted) {
  TilesOfParts tiles;
  for (const Part& part : counted.parts) {
    for (const PartTile& tile : part.tiles) {
      if (bucket_of(tile.id, job.plan.num_buckets) == bucket) tiles[tile.id].push_back({&part, &tile});
    }
  }
  return tiles;
}

// Those that are made of parts, and of the city's others those that get attributes that they had not.
std::vector<CityTile> make_tiles(const Job& job, std::size_t bucket, const CountedParts& counted,
                                 const SaveTile& save) {
  const TilesOfParts places = tiles_of_bucket(job, bucket, counted);
  const std::vector<TileId> ids = ids_of(places);
  std::vector<CityTile> tiles =
      renew_tiles(ids, {counted.base, counted.added, counted.layout, job.plan.files.build.epoch,
                        [&](const TileId& id) { return sums_of(places.at(id)); }, save});
  if (!counted.base || counted.layout == counted.base->manifest.layout) return tiles;
  std::vector<CityTile> others = tiles_without(*counted.base, ids);
  std::erase_if(others, [&](const CityTile& tile) { return bucket_of(tile.id, job.plan.num_buckets) != bucket; });
  for (CityTile& tile : keep_tiles(*counted.base, std::move(others), counted.layout, save)) {
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

void write_bucket(const Job& job, std::size_t bucket, const CountedParts& counted) {
  AtomicFolder folder(bucket_path(job.folder, bucket));
  const std::filesystem::path tiles = tiles_path(folder.temporary_path());
  std::error_code error;
  std::filesystem::create_directory(tiles, error);
  if (error) throw IoError::system(tiles, "cannot create", error.value());
  const SaveTile save = [&](const TileId& id, const VoxelMap& tile, const std::optional<Visibility>& seen) {
    return save_tile(tiles, id, tile, counted.layout.density, seen);
  };
  NewTiles made{counted.layout, make_tiles(job, bucket, counted, save), counted.sources};
  const CityManifest manifest = manifest_with(std::nullopt, {}, std::move(made), counted.epoch);
  write_file(manifest_path(folder.temporary_path()), text_of(manifest));
  write_file(key_path(folder.temporary_path()), job.key);
  sync_folder(tiles);
  sync_folder(folder.temporary_path());
  folder.commit();
  sync_folder(buckets_path(job.folder));
}

}  // namespace

ReduceOutcome reduce_bucket(const Job& job, std::size_t bucket) {
  check_bucket(job, bucket);
  if (is_published(job)) return ReduceOutcome::kWasThere;
  const CountedParts counted = open_parts(job);
  check_city(job.plan, counted);
  if (has_bucket(job, bucket, counted)) return ReduceOutcome::kWasThere;
  write_bucket(job, bucket, counted);
  return ReduceOutcome::kDone;
}

bool has_bucket(const Job& job, std::size_t bucket, const CountedParts& counted) {
  try {
    open_bucket(job, bucket, counted);
    return true;
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed) throw;
    return false;
  }
}

CityManifest open_bucket(const Job& job, std::size_t bucket, const CountedParts& counted) {
  const std::filesystem::path folder = bucket_path(job.folder, bucket);
  std::error_code missing;
  if (!std::filesystem::exists(folder, missing)) {
    throw IoError::malformed(folder, "is missing: bucket " + std::to_string(bucket) + " is not reduced yet");
  }
  CityManifest manifest = open_city(folder).manifest;
  ByteReader key(key_path(folder));
  if (key.bytes(key.size()) != job.key) throw IoError::malformed(folder, "is of another plan");
  const CityManifest expected = manifest_with(std::nullopt, {}, {counted.layout, {}, counted.sources}, counted.epoch);
  if (manifest.sources != expected.sources || manifest.layout != expected.layout || manifest.epoch != expected.epoch) {
    throw IoError::malformed(folder, "is of other parts: reduce it anew");
  }
  for (const CityTile& tile : manifest.tiles) {
    if (bucket_of(tile.id, job.plan.num_buckets) != bucket) throw IoError::malformed(folder, "is another bucket");
    check_tile_file(tile_path(folder, tile), tile);
  }
  return manifest;
}

}  // namespace vdbmap
