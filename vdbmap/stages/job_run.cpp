// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/job_run.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "vdbmap/stages/reduce_stage.h"

namespace vdbmap {
namespace {

// Calls body(i) for every i of [0, count), on so many threads of their own: each waits for its disk by itself, and for
// processors all share the threads that the process is allowed.
void run_tasks(std::size_t count, std::size_t num_jobs, const std::function<void(std::size_t)>& body) {
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> has_failed{false};
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !has_failed; i = next++) {
      try {
        body(i);
      } catch (...) {
        errors[i] = std::current_exception();
        has_failed = true;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min(num_jobs, count); ++i) others.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace

JobFinished run_job(const Job& job, const JobRunOptions& options) {
  if (is_published(job)) return finish_job(job);
  MapStageOptions map = options.map;
  map.memory_bytes /= std::max<std::size_t>(options.num_jobs, 1);
  options.on_map_begun(job.plan.sources.size());
  run_tasks(job.plan.sources.size(), options.num_jobs, [&](std::size_t i) {
    map_source(job, i, map);
    options.on_task_done();
  });
  options.on_reduce_begun(job.plan.num_buckets);
  run_tasks(job.plan.num_buckets, options.num_jobs, [&](std::size_t i) {
    reduce_bucket(job, i);
    options.on_task_done();
  });
  return finish_job(job);
}

}  // namespace vdbmap
