// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "vdbmap/stages/job_folder.h"

namespace vdbmap {

/// What a job is to make.
struct JobOptions {
  std::filesystem::path city;  ///< folder of the city
  bool adds = false;           ///< to the city that is there
  MapFromFilesOptions files;
  SaveOptions save;
  std::size_t keep_epochs = std::numeric_limits<std::size_t>::max();
  bool keeps_parts = false;                         ///< in a new city
  std::size_t num_buckets = 0;                      ///< 0: one a GB of inputs, at least 4, at most 1000
  std::size_t memory_bytes = std::size_t{2} << 30;  ///< that looking into the first source may take
  bool skips_bad = false;                           ///< a first source that cannot be read is left out
};

/// Plans a job: of the inputs, names and sizes alone. Where no anchor is given and none is there, the first source by
/// name is read for it, as build_city() does; sources of that same name are hashed, since their hashes decide which is
/// first. Throws as build_city() does for options, a city that cannot be written or added to, and the first source;
/// IoError where an input is missing or the folder cannot be written; std::invalid_argument where it holds another
/// plan.
Job plan_job(const std::filesystem::path& folder, const std::vector<MapInput>& inputs, const JobOptions& options);

}  // namespace vdbmap
