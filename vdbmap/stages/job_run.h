// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "vdbmap/stages/finish_stage.h"
#include "vdbmap/stages/map_stage.h"

namespace vdbmap {

/// How a job is run in one process.
struct JobRunOptions {
  std::size_t num_jobs = 1;  ///< sources, or buckets, at a time; they share the memory of `map`
  MapStageOptions map;
  std::function<void(std::size_t num_sources)> on_map_begun = [](std::size_t) {};
  std::function<void(std::size_t num_buckets)> on_reduce_begun = [](std::size_t) {};
  std::function<void()> on_task_done = [] {};  ///< called by any thread
};

/// Maps, reduces and finishes what is left to do of a job. Throws what a stage throws, of several the one of the lowest
/// number; tasks that run then come to their end, others do not begin.
JobFinished run_job(const Job& job, const JobRunOptions& options);

}  // namespace vdbmap
