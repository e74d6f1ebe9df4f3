// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "registration/coarse/fpfh.h"

namespace vdbmap::registration {

/// A point of the source that may be a point of the target.
struct FeatureMatch {
  std::uint32_t source = 0;
  std::uint32_t target = 0;
  float distance = 0;   ///< between the features, Euclidean
  bool mutual = false;  ///< each is the other's nearest
};

/// Mutual ones first, then by distance; ties are broken by number.
void sort_best_first(std::vector<FeatureMatch>& matches);

/// For each of the chosen source features the `num_nearest` nearest of the chosen target features, the best first over
/// all: mutual ones, then by distance. Ties are broken by number, so the order is the same for any number of threads.
std::vector<FeatureMatch> match_features(const FpfhMatrix& source, const std::vector<std::uint32_t>& chosen_source,
                                         const FpfhMatrix& target, const std::vector<std::uint32_t>& chosen_target,
                                         int num_nearest);

}  // namespace vdbmap::registration
