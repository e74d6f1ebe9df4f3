// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vdbmap/stages/job_folder.h"

namespace vdbmap {

/// What of a job is done and what is left to do.
struct JobStatus {
  std::vector<std::size_t> missing_sources;  ///< whose part is missing, damaged or not of this job
  std::vector<std::size_t> missing_buckets;  ///< all of them while a part is missing
  std::vector<LeftOutSource> left_out;
  bool is_published = false;
  std::string problem;  ///< why the job cannot go on as it is; empty where it can
};

/// Looks at all that the job's folder holds. Throws IoError where it cannot be read.
JobStatus find_status(const Job& job);

}  // namespace vdbmap
