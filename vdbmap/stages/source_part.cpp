// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/source_part.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/store/source_hash.h"
#include "vdbmap/store/sums_file.h"

namespace vdbmap {
namespace {

std::string plan_in_part(const Job& job) { return "plan " + job.key + ", source "; }

}  // namespace

void write_part(const Job& job, std::size_t source, const PartNotes& found, TileSums& sums) {
  std::vector<TileId> ids = sums.tiles();
  std::ranges::sort(ids, {}, [&](const TileId& id) { return std::tuple(bucket_of(id, job.plan.num_buckets), id); });
  write_part(part_path(job.folder, source), plan_in_part(job) + std::to_string(source), found, ids,
             [&](const TileId& id) { return pack_sums(sums.take(id)); });
  sync_folder(parts_path(job.folder));
}

Part open_part(const Job& job, std::size_t source) {
  const MapInput& input = job.plan.sources[source].input;
  Part part = open_part(part_path(job.folder, source), source_name(input), input.scan.file);
  const std::string plan = plan_in_part(job);
  if (!part.made_for.starts_with(plan)) throw IoError::malformed(part.path, "is of another plan");
  const std::string number = part.made_for.substr(plan.size());
  if (number != std::to_string(source)) throw IoError::malformed(part.path, "is of source " + number);
  return part;
}

}  // namespace vdbmap
