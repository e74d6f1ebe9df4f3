// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/carrying.h"

#include <array>
#include <optional>
#include <tuple>

#include "vdbmap/core/parallel_tasks.h"

namespace vdbmap::registration {
namespace {

// The place of a scan whose neighbour's is known; none where the guesses have become too many.
ScanPlace carried_on(const ScanPlace& neighbour, const Eigen::Isometry3d& neighbour_from_scan, std::size_t scan,
                     const TrackScan& track, const CarryOptions& options) {
  const std::size_t num_guesses = neighbour.source == PlaceSource::kGuess ? neighbour.num_guesses : 0;
  if (!neighbour.is_known() || num_guesses >= options.max_guesses) return {};
  const Eigen::Isometry3d guess = neighbour.map_from_scan * neighbour_from_scan;
  const TrackedPose tracked = track(scan, guess);
  if (tracked.inlier_share >= options.min_inlier_share) {
    return {PlaceSource::kTracked, tracked.map_from_scan, tracked.inlier_share, 0};
  }
  return {PlaceSource::kGuess, guess, 0, num_guesses + 1};
}

// All places, with what is carried in one direction from those found.
std::vector<ScanPlace> carried_one_way(std::span<const ScanPlace> found, std::span<const PathPose> path,
                                       const TrackScan& track, const CarryOptions& options, bool is_forward) {
  std::vector<ScanPlace> places(found.begin(), found.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t scan = is_forward ? i : places.size() - 1 - i;
    const std::optional<std::size_t> from = linked_scan(path, scan, is_forward);
    if (places[scan].is_known() || !from) continue;
    places[scan] = carried_on(places[*from], step_between(path[*from], path[scan]), scan, track, options);
  }
  return places;
}

// Of two places of a scan. Fewer guesses are better, so they count below zero.
bool is_better(const ScanPlace& a, const ScanPlace& b) {
  return std::tuple(a.source, a.inlier_share, b.num_guesses) > std::tuple(b.source, b.inlier_share, a.num_guesses);
}

}  // namespace

std::vector<ScanPlace> carry_places(std::span<const ScanPlace> found, std::span<const PathPose> path,
                                    const TrackScan& track, const CarryOptions& options) {
  std::array<std::vector<ScanPlace>, 2> ways;
  parallel_tasks(ways.size(), [&](std::size_t i) { ways[i] = carried_one_way(found, path, track, options, i == 0); });
  auto& [places, backward] = ways;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is_better(backward[i], places[i])) places[i] = backward[i];
  }
  return places;
}

}  // namespace vdbmap::registration
