// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/finish_stage.h"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/stages/reduce_stage.h"
#include "vdbmap/store/city_base.h"
#include "vdbmap/store/city_writer.h"
#include "vdbmap/store/content_hash.h"

namespace vdbmap {
namespace {

// The state of the city that the job is about to publish, or has published.
std::filesystem::path published_path(const Job& job) { return job.folder / "published"; }

// A tile, and the city in the job's folder in which it lies.
struct MadeTile {
  CityTile tile;
  std::filesystem::path folder;
};

std::vector<MadeTile> made_tiles(const Job& job, const CountedParts& counted) {
  std::vector<CityManifest> buckets(job.plan.num_buckets);
  parallel_tasks(buckets.size(), [&](std::size_t i) { buckets[i] = open_bucket(job, i, counted); });
  std::vector<MadeTile> made;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    for (CityTile& tile : buckets[i].tiles) made.push_back({std::move(tile), bucket_path(job.folder, i)});
  }
  return made;
}

CityManifest manifest_of(const CountedParts& counted, const std::vector<MadeTile>& made) {
  NewTiles tiles{counted.layout, {}, counted.sources};
  std::vector<TileId> ids;
  for (const MadeTile& tile : made) {
    tiles.tiles.push_back(tile.tile);
    ids.push_back(tile.tile.id);
  }
  std::ranges::sort(ids);
  std::vector<CityTile> kept;
  if (counted.base) kept = tiles_without(*counted.base, ids);
  return manifest_with(counted.base, std::move(kept), std::move(tiles), counted.epoch);
}

// The parts of the job become those of the city, as build_city() writes them.
std::vector<CityPart> keep_parts(const Job& job, const CountedParts& counted, const CityWriter& writer) {
  std::vector<CityPart> kept;
  for (const Part& part : counted.parts) {
    std::map<TileId, const PartTile*> tiles;
    for (const PartTile& tile : part.tiles) tiles[tile.id] = &tile;
    std::vector<TileId> ids;
    for (const auto& [id, tile] : tiles) ids.push_back(id);
    const PartNotes found = to_be_kept(part.found, job.plan.files.build.epsg);
    kept.push_back(writer.save_part(found, ids, [&](const TileId& id) { return packed_tile(part, *tiles.at(id)); }));
  }
  std::ranges::sort(kept, {}, &CityPart::source);
  return kept;
}

CityManifest publish(const Job& job, const CountedParts& counted) {
  const std::vector<MadeTile> made = made_tiles(job, counted);
  CityWriter writer(job.plan.city);
  check_city(job.plan, counted);
  CityManifest manifest = manifest_of(counted, made);
  if (job.plan.keeps_parts) manifest.parts = keep_parts(job, counted, writer);
  parallel_tasks(made.size(), [&](std::size_t i) { writer.adopt_tile(made[i].tile, made[i].folder); });
  write_file(published_path(job), hash_of_bytes(text_of(manifest)));
  writer.publish(manifest, job.plan.keep_epochs);
  return manifest;
}

}  // namespace

bool is_published(const Job& job) {
  std::error_code missing;
  if (!std::filesystem::exists(published_path(job), missing)) return false;
  ByteReader state(published_path(job));
  return state.bytes(state.size()) == city_state(job.plan.city);
}

void check_city(const JobPlan& plan, const CountedParts& counted) {
  if (city_state(plan.city) != plan.city_state) {
    throw IoError::malformed(plan.city, "has changed since the job was planned: plan it anew");
  }
  if (plan.adds || plan.city_state.empty()) return;
  check_replaceable(open_city(plan.city), read_epochs(plan.city).size(), counted.sources);
}

JobFinished finish_job(const Job& job) {
  if (is_published(job)) return {{open_city(job.plan.city).manifest, {}, {}, {}}, {}, true};
  CountedParts counted = open_parts(job);
  check_city(job.plan, counted);
  JobFinished finished{{{}, std::move(counted.notes), counted.sources, counted.not_counted}, counted.left_out};
  finished.built.manifest = counted.sources.empty() ? counted.base->manifest : publish(job, counted);
  return finished;
}

}  // namespace vdbmap
