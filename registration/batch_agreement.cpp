// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/batch_agreement.h"

#include <algorithm>
#include <bitset>
#include <numbers>

#include "vdbmap/core/option_check.h"

namespace vdbmap::registration {
namespace {

// Batches on either side that judge one: farther ones are a drive away, where odometry says little.
constexpr std::size_t kNeighbours = 16;
constexpr std::size_t kSpan = 2 * kNeighbours;  // between the ends of such a neighbourhood

constexpr double kRadians = std::numbers::pi / 180;

// A batch on the part of the path that it belongs to.
struct PlaceOnWay {
  Eigen::Isometry3d map_from_batch;
  Eigen::Isometry3d odometry_from_batch;
  double way;  // [m] from the begin of the path
};

using Part = std::span<const PlaceOnWay>;

// Whether odometry leads from one place to the other.
bool do_agree(const PlaceOnWay& a, const PlaceOnWay& b, const DriftModel& drift) {
  const Eigen::Isometry3d predicted = a.map_from_batch * (a.odometry_from_batch.inverse() * b.odometry_from_batch);
  const Eigen::Isometry3d difference = predicted.inverse() * b.map_from_batch;
  const DriftAllowance allowed = allowance_after(b.way - a.way, drift);
  return difference.translation().norm() < allowed.translation &&
         Eigen::AngleAxisd(difference.linear()).angle() < allowed.turn;
}

// Which of the batches before each, the nearest first, agree with it.
using Agreements = std::vector<std::bitset<kSpan>>;

Agreements agreements_of(Part part, const DriftModel& drift) {
  Agreements agreements(part.size());
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (std::size_t k = 0; k < std::min(i, kSpan); ++k) agreements[i][k] = do_agree(part[i - 1 - k], part[i], drift);
  }
  return agreements;
}

// Numbers of batches in the longest chains of agreement up to each of the batches [begin, end), and from each on.
struct Chains {
  std::vector<std::size_t> up_to;
  std::vector<std::size_t> from;
};

Chains chains_in(const Agreements& agreements, std::size_t begin, std::size_t end) {
  const std::size_t size = end - begin;
  Chains chains{std::vector<std::size_t>(size, 1), std::vector<std::size_t>(size, 1)};
  const auto do_follow = [&](std::size_t a, std::size_t b) { return agreements[begin + b][b - 1 - a]; };
  for (std::size_t b = 0; b < size; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (do_follow(a, b)) chains.up_to[b] = std::max(chains.up_to[b], chains.up_to[a] + 1);
    }
  }
  for (std::size_t a = size; a-- > 0;) {
    for (std::size_t b = a + 1; b < size; ++b) {
      if (do_follow(a, b)) chains.from[a] = std::max(chains.from[a], chains.from[b] + 1);
    }
  }
  return chains;
}

// Whether a batch belongs to every longest chain of its neighbourhood, and that holds more than half of the batches. A
// batch has one rank in all longest chains through it: where another has the same, either may be the false one.
bool is_believed(const Agreements& agreements, std::size_t batch) {
  const std::size_t begin = batch > kNeighbours ? batch - kNeighbours : 0;
  const std::size_t end = std::min(agreements.size(), batch + kNeighbours + 1);
  const Chains chains = chains_in(agreements, begin, end);
  const std::size_t longest = *std::max_element(chains.up_to.begin(), chains.up_to.end());
  const std::size_t rank = chains.up_to[batch - begin];
  std::size_t num_of_rank = 0;
  for (std::size_t i = 0; i < end - begin; ++i) {
    const bool is_in_longest = chains.up_to[i] + chains.from[i] - 1 == longest;
    if (i == batch - begin && !is_in_longest) return false;
    if (is_in_longest && chains.up_to[i] == rank) ++num_of_rank;
  }
  return num_of_rank == 1 && 2 * longest > end - begin;
}

// [m] from the first scan to each, as odometry went.
std::vector<double> ways_along(std::span<const PathPose> path) {
  std::vector<double> ways(path.size());
  for (std::size_t i = 1; i < path.size(); ++i) {
    ways[i] = ways[i - 1] + (path[i].follows ? step_between(path[i - 1], path[i]).translation().norm() : 0);
  }
  return ways;
}

// The number of gaps up to each scan.
std::vector<std::size_t> gaps_along(std::span<const PathPose> path) {
  std::vector<std::size_t> gaps(path.size());
  for (std::size_t i = 1; i < path.size(); ++i) gaps[i] = gaps[i - 1] + (path[i].follows ? 0 : 1);
  return gaps;
}

}  // namespace

void DriftModel::check() const {
  require(translation >= 0, "translation", translation, "0 or more");
  require(turn_deg >= 0, "turn_deg", turn_deg, "0 or more");
  require(translation_per_metre >= 0, "translation_per_metre", translation_per_metre, "0 or more");
  require(turn_deg_per_metre >= 0, "turn_deg_per_metre", turn_deg_per_metre, "0 or more");
}

DriftAllowance allowance_after(double way, const DriftModel& drift) {
  const double turn_per_metre = kRadians * drift.turn_deg_per_metre;
  return {drift.translation + drift.translation_per_metre * way + turn_per_metre * way * way / 2,
          kRadians * drift.turn_deg + turn_per_metre * way};
}

std::vector<bool> believed_batches(std::span<const BatchPlace> batches, std::span<const PathPose> path,
                                   const DriftModel& drift) {
  drift.check();
  const std::vector<double> ways = ways_along(path);
  const std::vector<std::size_t> gaps = gaps_along(path);
  std::vector<bool> believed;
  for (std::size_t i = 0; i < batches.size();) {
    std::vector<PlaceOnWay> part;
    const std::size_t gap = gaps[batches[i].first_scan];
    for (; i < batches.size() && gaps[batches[i].first_scan] == gap; ++i) {
      const std::size_t scan = batches[i].first_scan;
      part.push_back({batches[i].map_from_batch, path[scan].odometry_from_scan, ways[scan]});
    }
    const Agreements agreements = agreements_of(part, drift);
    for (std::size_t k = 0; k < part.size(); ++k) believed.push_back(is_believed(agreements, k));
  }
  return believed;
}

}  // namespace vdbmap::registration
