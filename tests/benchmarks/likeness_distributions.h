// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "vdbmap/core/point_cloud.h"

namespace vdbmap::benchmarks {

enum Group { kGround, kFacade, kVegetation, kVehicle, kFence, kPole, kOther, kNumGroups };

const char* name_of(Group group);

/// A scan in its scanner's frame, and what each point lies on.
struct LabelledScan {
  PointCloud cloud;
  std::vector<Group> groups;
};

/// Samples of one figure, sorted; those of a share are one number a group.
struct Distribution {
  std::string name;
  std::vector<double> samples;
  bool is_shares = false;
};

using Distributions = std::vector<Distribution>;

/// What a place's scans are like, in the same order for every place: shares of the groups; ranges; and of each of
/// ground, facades, vegetation, vehicles and poles the linearity, planarity and scattering (Weinmann 2015) of voxels of
/// 0.2, 0.5 and 1 m from 5 points on, the height over the lowest ground within 3 m, and the points a voxel of 0.2 m.
Distributions distributions_of(const std::vector<LabelledScan>& scans);

/// From 0 to 1: of shares the total variation, half the sum of their differences; else Kolmogorov's and Smirnov's, the
/// largest difference between the cumulative distributions. 1 where one of the two has no samples.
double distance(const Distribution& a, const Distribution& b);

}  // namespace vdbmap::benchmarks
