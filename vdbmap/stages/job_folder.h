// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "vdbmap/stages/job_plan.h"

/// Where things are in the folder of a job:
///
///     job.json           the plan
///     parts/K.part       sums of source K
///     parts/K.left_out   why source K is left out, instead of its part
///     tiles/B/           finished tiles of bucket B: a city of them, and the key of the plan
namespace vdbmap {

/// A job as its folder says.
struct Job {
  std::filesystem::path folder;
  JobPlan plan;
  std::string key;  ///< hash of the plan: what was made for another has another
};

std::filesystem::path plan_path(const std::filesystem::path& folder);
std::filesystem::path parts_path(const std::filesystem::path& folder);
std::filesystem::path part_path(const std::filesystem::path& folder, std::size_t source);
std::filesystem::path left_out_path(const std::filesystem::path& folder, std::size_t source);
std::filesystem::path buckets_path(const std::filesystem::path& folder);
std::filesystem::path bucket_path(const std::filesystem::path& folder, std::size_t bucket);

/// Opens a job. Throws IoError: malformed for a folder that is none and a damaged or newer plan.
Job open_job(const std::filesystem::path& folder);

/// Makes a folder a job. The same plan again changes nothing; throws std::invalid_argument where another is there, and
/// IoError where the folder cannot be written or holds something else.
Job create_job(const std::filesystem::path& folder, const JobPlan& plan);

/// Throws std::invalid_argument unless the plan has a source, or bucket, of that number.
void check_source(const Job& job, std::size_t source);
void check_bucket(const Job& job, std::size_t bucket);

/// Says that a source is left out, and why; replaces what was said before. Throws IoError (system).
void leave_out(const Job& job, std::size_t source, const std::string& reason);

/// What leave_out() said of a source, with its name; nothing where it is not left out. Throws IoError.
std::optional<LeftOutSource> left_out_source(const Job& job, std::size_t source);

}  // namespace vdbmap
