// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "vdbmap/stages/counted_parts.h"

namespace vdbmap {

/// What became of a bucket.
enum class ReduceOutcome {
  kDone,
  kWasThere,  ///< its tiles are there already, or published
};

/// Finishes the tiles of a bucket, one a thread at a time: of exactly the parts that the plan names, and of what the
/// city has there where the job adds to one. They are a city of their own in the job's folder. What is there of the
/// same parts stays, anything else is replaced. Throws as open_parts(), IoError where the city cannot become that of
/// the job any more, std::invalid_argument for a number that the plan has not.
ReduceOutcome reduce_bucket(const Job& job, std::size_t bucket);

/// The tiles of a bucket. Throws IoError: malformed where it is missing, damaged, of another plan or of other parts.
CityManifest open_bucket(const Job& job, std::size_t bucket, const CountedParts& counted);

/// Whether open_bucket() succeeds. Throws IoError (system).
bool has_bucket(const Job& job, std::size_t bucket, const CountedParts& counted);

}  // namespace vdbmap
