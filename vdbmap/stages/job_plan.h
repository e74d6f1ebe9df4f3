// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/core/tile_id.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {

/// A source that a job is to count.
struct PlannedSource {
  MapInput input;               ///< its files are absolute paths
  std::uint64_t num_bytes = 0;  ///< of its file
};

/// A source that was left out since it could not be read, and why.
struct LeftOutSource {
  std::string name;
  std::string reason;

  bool operator==(const LeftOutSource&) const = default;
};

/// All that decides what the stages of a job make: machines that know the plan need not know of each other.
struct JobPlan {
  std::filesystem::path city;  ///< absolute; where the job's tiles are published
  bool adds = false;           ///< to the city that is there, instead of making one
  std::string city_state;      ///< city_state() of it when the plan was made
  MapFromFilesOptions files;   ///< with an anchor
  SaveOptions save;
  std::size_t keep_epochs = std::numeric_limits<std::size_t>::max();
  bool keeps_parts = false;             ///< as CityBuildOptions has it
  std::size_t num_buckets = 1;          ///< of tiles that are finished together
  std::vector<PlannedSource> sources;   ///< in the order of their names
  std::vector<LeftOutSource> left_out;  ///< while the plan was made
};

/// Version of the plans that we write; of others nothing is known.
inline constexpr std::int32_t kJobFormat = 2;

/// The plan as JSON, a line a source. Equal plans give equal texts. Throws std::invalid_argument for names that are not
/// UTF-8, which JSON cannot hold.
std::string text_of(const JobPlan& plan);

/// Reads what text_of() wrote. Throws IoError (malformed) for anything else.
JobPlan parse_job_plan(std::string_view text, const std::filesystem::path& path);

/// The bucket of a tile: neighbours go to different ones, so that buckets are of like size.
std::size_t bucket_of(const TileId& tile, std::size_t num_buckets);

}  // namespace vdbmap
