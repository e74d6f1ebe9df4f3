// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "vdbmap/stages/counted_parts.h"
#include "vdbmap/store/city_build.h"

namespace vdbmap {

/// What a job came to.
struct JobFinished {
  CityBuilt built;
  std::vector<LeftOutSource> left_out;
  bool was_published = false;  ///< before: `built` has the manifest only
};

/// Publishes the tiles of all buckets as the city, in one moment and under its lock; the bytes are those that
/// build_city(), or add_to_city(), writes of the same sources. Throws as open_parts() and open_bucket() do, and IoError
/// where another process writes the city or it is no longer as it was when the job was planned; the city is then as it
/// was.
JobFinished finish_job(const Job& job);

/// Whether the city is as the job left it.
bool is_published(const Job& job);

/// Throws where the city cannot become that of the job: IoError where it has changed since the job was planned,
/// std::invalid_argument where it is one of other sources that would be replaced.
void check_city(const JobPlan& plan, const CountedParts& counted);

}  // namespace vdbmap
