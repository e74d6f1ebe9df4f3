// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/likeness_distributions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "vdbmap/core/eigen_features.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/voxel_record.h"

namespace vdbmap::benchmarks {
namespace {

constexpr std::array<double, 3> kSizes = {0.2, 0.5, 1.0};  // [m] of voxels whose shape is compared
constexpr std::array<const char*, 3> kSizeNames = {"0.2 m", "0.5 m", "1 m"};
constexpr std::uint32_t kFewestPoints = 5;  // of a voxel that has a shape
constexpr double kGroundCell = 2;           // [m], with those around it: the lowest ground within 3 m of its middle
constexpr std::array<Group, 5> kShaped = {kGround, kFacade, kVegetation, kVehicle, kPole};

using Cell = std::pair<int, int>;

Cell cell_of(const Eigen::Vector3d& point) {
  return {static_cast<int>(std::floor(point.x() / kGroundCell)), static_cast<int>(std::floor(point.y() / kGroundCell))};
}

std::map<Cell, double> lowest_ground(const LabelledScan& scan) {
  std::map<Cell, double> lowest;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    if (scan.groups[i] != kGround) continue;
    const Eigen::Vector3d& point = scan.cloud.positions[i];
    const auto [x, y] = cell_of(point);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        double& low = lowest.try_emplace({x + dx, y + dy}, point.z()).first->second;
        low = std::min(low, point.z());
      }
    }
  }
  return lowest;
}

// Samples of one group, by figure.
struct GroupSamples {
  std::array<std::vector<double>, kSizes.size()> linearity, planarity, scattering;
  std::vector<double> height, density;
};

void add_shapes(const PointCloud& cloud, GroupSamples& samples) {
  for (std::size_t size = 0; size < kSizes.size(); ++size) {
    BuildOptions options;
    options.voxel_sizes = {kSizes[size]};
    const VoxelMap map = build_map(cloud, options);
    for (const VoxelRecord& record : map.finest().records()) {
      if (size == 0) samples.density.push_back(record.count);
      if (record.count < kFewestPoints) continue;
      const EigenFeatures shape = eigen_features(covariance_of(record));
      samples.linearity[size].push_back(shape.linearity);
      samples.planarity[size].push_back(shape.planarity);
      samples.scattering[size].push_back(shape.scattering);
    }
  }
}

void add_scan(const LabelledScan& scan, Group group, const std::map<Cell, double>& ground, GroupSamples& samples) {
  PointCloud cloud;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    if (scan.groups[i] != group) continue;
    const Eigen::Vector3d& point = scan.cloud.positions[i];
    cloud.positions.push_back(point);
    const auto below = ground.find(cell_of(point));
    if (below != ground.end()) samples.height.push_back(point.z() - below->second);
  }
  if (cloud.size() > 0) add_shapes(cloud, samples);
}

class Collector {
 public:
  void add(const std::string& name, std::vector<double> samples, bool is_shares = false) {
    if (!is_shares) std::ranges::sort(samples);
    distributions_.push_back({name, std::move(samples), is_shares});
  }

  void add(Group group, GroupSamples samples) {
    const std::string of = std::string(name_of(group)) + ": ";
    for (std::size_t size = 0; size < kSizes.size(); ++size) {
      add(of + "linearity, " + kSizeNames[size], std::move(samples.linearity[size]));
      add(of + "planarity, " + kSizeNames[size], std::move(samples.planarity[size]));
      add(of + "scattering, " + kSizeNames[size], std::move(samples.scattering[size]));
    }
    add(of + "height over ground", std::move(samples.height));
    add(of + "points a voxel of 0.2 m", std::move(samples.density));
  }

  Distributions take() { return std::move(distributions_); }

 private:
  Distributions distributions_;
};

double total_variation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b.at(i));
  return sum / 2;
}

double largest_gap(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return 1;
  double largest = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double value = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= value) ++i;
    while (j < b.size() && b[j] <= value) ++j;
    largest = std::max(largest, std::abs(static_cast<double>(i) / static_cast<double>(a.size()) -
                                         static_cast<double>(j) / static_cast<double>(b.size())));
  }
  return largest;
}

}  // namespace

const char* name_of(Group group) {
  constexpr std::array<const char*, kNumGroups> kNames = {"ground", "facades", "vegetation",    "vehicles",
                                                          "fences", "poles",   "other, unknown"};
  return kNames[static_cast<std::size_t>(group)];
}

Distributions distributions_of(const std::vector<LabelledScan>& scans) {
  std::vector<double> shares(kNumGroups), ranges;
  std::array<GroupSamples, kShaped.size()> samples;
  for (const LabelledScan& scan : scans) {
    for (const Group group : scan.groups) shares[group] += 1;
    for (const Eigen::Vector3d& point : scan.cloud.positions) ranges.push_back(point.norm());
    const std::map<Cell, double> ground = lowest_ground(scan);
    for (std::size_t i = 0; i < kShaped.size(); ++i) add_scan(scan, kShaped[i], ground, samples[i]);
  }
  for (double& share : shares) share /= static_cast<double>(ranges.size());
  Collector collector;
  collector.add("shares of classes", std::move(shares), true);
  collector.add("range", std::move(ranges));
  for (std::size_t i = 0; i < kShaped.size(); ++i) collector.add(kShaped[i], std::move(samples[i]));
  return collector.take();
}

double distance(const Distribution& a, const Distribution& b) {
  return a.is_shares ? total_variation(a.samples, b.samples) : largest_gap(a.samples, b.samples);
}

}  // namespace vdbmap::benchmarks
