// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/job_status.h"

#include <functional>
#include <optional>
#include <stdexcept>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel_tasks.h"
#include "vdbmap/stages/finish_stage.h"
#include "vdbmap/stages/map_stage.h"
#include "vdbmap/stages/reduce_stage.h"

namespace vdbmap {
namespace {

std::vector<std::size_t> missing_of(std::size_t count, const std::function<bool(std::size_t)>& is_there) {
  std::vector<char> is_missing(count, 0);
  parallel_tasks(count, [&](std::size_t i) { is_missing[i] = is_there(i) ? 0 : 1; });
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_missing[i]) missing.push_back(i);
  }
  return missing;
}

// What the parts come to; where they do not go together, or with the city, that is the problem.
std::optional<CountedParts> open_all(const Job& job, std::string& problem) {
  try {
    CountedParts counted = open_parts(job);
    check_city(job.plan, counted);
    return counted;
  } catch (const IoError& error) {
    if (error.kind() != IoError::Kind::kMalformed) throw;
    problem = error.what();
  } catch (const std::invalid_argument& error) {
    problem = error.what();
  }
  return std::nullopt;
}

}  // namespace

JobStatus find_status(const Job& job) {
  JobStatus status;
  status.is_published = is_published(job);
  status.left_out = job.plan.left_out;
  const std::size_t num_sources = job.plan.sources.size();
  for (std::size_t i = 0; i < num_sources; ++i) {
    if (has_part(job, i)) continue;
    if (const std::optional<LeftOutSource> source = left_out_source(job, i)) status.left_out.push_back(*source);
  }
  if (status.is_published) return status;
  status.missing_sources =
      missing_of(num_sources, [&](std::size_t i) { return has_part(job, i) || left_out_source(job, i); });
  std::optional<CountedParts> counted;
  if (status.missing_sources.empty()) counted = open_all(job, status.problem);
  status.missing_buckets =
      missing_of(job.plan.num_buckets, [&](std::size_t i) { return counted && has_bucket(job, i, *counted); });
  return status;
}

}  // namespace vdbmap
