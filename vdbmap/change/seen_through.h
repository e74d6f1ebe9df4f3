// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbmap/change/presence.h"
#include "vdbmap/core/voxel_level.h"

namespace vdbmap {

/// When what voxels hold counts as gone, or as having moved on.
///
/// Times are compared, not numbers of rays: what stands is hit whenever it is looked at, though rays pass beside a pole
/// and through a hedge all the time; what moves, or is gone, is passed when nothing is there. A time counts as passed
/// where a ray went through one of the 5 x 5 x 5 voxels around and no point fell into one of the 3 x 3 x 3, as what
/// stands in a street is larger than a voxel. A voxel whose times were passed mostly is sure; one with fewer is likely,
/// and goes with sure ones that it touches.
struct SeenThroughOptions {
  double sure_share = 0.5;     ///< of the times at which something was there or passed: passed ones
  double likely_share = 0.25;  ///< the same of voxels that go with sure ones
  double sure_part = 0.5;      ///< of a group of touching likely voxels that must be sure
  int min_times = 2;           ///< passed, for a sure voxel
  double ray_share = 0.35;     ///< of the rays that went through voxels around or ended there: gone through, at least

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// How much speaks for a voxel being seen through, by itself.
enum class SeenGrade : std::uint8_t { kNot, kLikely, kSure };

/// One value a record of `level`; see find_seen_through(). What is up to two voxels around decides.
std::vector<SeenGrade> grade_seen_through(const VoxelLevel& level, const std::vector<std::uint32_t>& passes,
                                          const std::vector<TimeBins>& pass_times, const VoxelLevel& drive,
                                          const std::vector<TimeBins>& presence,
                                          const SeenThroughOptions& options = {});

/// Voxels in a group differ by at most so much on each axis, or a chain of such leads from one to the other.
inline constexpr std::int32_t kReachOfGroups = 1;

/// Which records have a grade: they go in groups.
std::vector<std::uint8_t> are_graded(const std::vector<SeenGrade>& grades);

/// How many records of a group are sure.
std::size_t count_sure(const std::vector<std::size_t>& group, const std::vector<SeenGrade>& grades);

/// Whether all of a group of touching voxels that are likely or sure are seen through, or the sure ones alone.
inline bool goes_whole(std::size_t num_sure, std::size_t num_voxels, const SeenThroughOptions& options) {
  return static_cast<double>(num_sure) >= options.sure_part * static_cast<double>(num_voxels);
}

/// One value a record of `level`, 1 where it was seen through: when rays went through its voxels, and when points fell
/// into voxels of `drive`, which has the same size and may be the same level.
std::vector<std::uint8_t> find_seen_through(const VoxelLevel& level, const std::vector<std::uint32_t>& passes,
                                            const std::vector<TimeBins>& pass_times, const VoxelLevel& drive,
                                            const std::vector<TimeBins>& presence,
                                            const SeenThroughOptions& options = {});

}  // namespace vdbmap
