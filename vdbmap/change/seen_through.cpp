// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/seen_through.h"

#include <algorithm>
#include <cstddef>

#include "vdbmap/core/option_check.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_groups.h"

namespace vdbmap {
namespace {

constexpr std::int32_t kReachOfPasses = 2;    // voxels around one whose rays count too
constexpr std::int32_t kReachOfPresence = 1;  // voxels around one in which something counts as being there

std::size_t number_of(const VoxelRecord& record, const VoxelLevel& level) {
  return static_cast<std::size_t>(&record - level.records().data());
}

class Grading {
 public:
  Grading(const VoxelLevel& level, const std::vector<std::uint32_t>& passes, const std::vector<TimeBins>& pass_times,
          const VoxelLevel& drive, const std::vector<TimeBins>& presence, const SeenThroughOptions& options)
      : level_(level),
        passes_(passes),
        pass_times_(pass_times),
        drive_(drive),
        presence_(presence),
        options_(options) {}

  std::vector<SeenGrade> grades() const {
    std::vector<SeenGrade> grades(level_.size());
    parallel_ranges(level_.leaves().size(), 64, [&](std::size_t begin, std::size_t end) {
      const VoxelFinder around(level_);
      const VoxelFinder drive(drive_);
      for (std::size_t i = begin; i < end; ++i) {
        for_each_voxel(level_.leaves()[i], [&](const VoxelIndex& voxel, std::size_t record) {
          grades[record] = grade_of(voxel, around, drive);
        });
      }
    });
    return grades;
  }

 private:
  SeenGrade grade_of(const VoxelIndex& voxel, const VoxelFinder& around, const VoxelFinder& drive) const {
    TimeBins passed;
    std::uint64_t num_rays = 0;
    std::uint64_t num_points = 0;
    around.for_each_around(voxel, kReachOfPasses, [&](const VoxelIndex& /*near*/, const VoxelRecord& record) {
      passed |= pass_times_[number_of(record, level_)];
      num_rays += passes_[number_of(record, level_)];
    });
    if (passed.count() == 0) return SeenGrade::kNot;
    TimeBins there;
    drive.for_each_around(voxel, kReachOfPresence, [&](const VoxelIndex& /*near*/, const VoxelRecord& record) {
      there |= presence_[number_of(record, drive_)];
      num_points += record.count;
    });
    const int num_passed = passed.without(there.widened()).count();
    const double ray_share =
        static_cast<double>(num_rays) / static_cast<double>(std::max<std::uint64_t>(num_rays + num_points, 1));
    if (ray_share < options_.ray_share) return SeenGrade::kNot;
    const double share = num_passed / static_cast<double>(std::max(num_passed + there.count(), 1));
    if (share > options_.sure_share && num_passed >= options_.min_times) return SeenGrade::kSure;
    return share > options_.likely_share ? SeenGrade::kLikely : SeenGrade::kNot;
  }

  const VoxelLevel& level_;
  const std::vector<std::uint32_t>& passes_;
  const std::vector<TimeBins>& pass_times_;
  const VoxelLevel& drive_;
  const std::vector<TimeBins>& presence_;
  const SeenThroughOptions& options_;
};

}  // namespace

void SeenThroughOptions::check() const {
  require(sure_share > 0 && sure_share < 1, "sure_share", sure_share, "between 0 and 1");
  require(likely_share > 0 && likely_share <= sure_share, "likely_share", likely_share, "above 0 to sure_share");
  require(sure_part >= 0 && sure_part <= 1, "sure_part", sure_part, "0 to 1");
  require(min_times >= 1 && min_times <= 32, "min_times", min_times, "1 to 32");
}

std::vector<SeenGrade> grade_seen_through(const VoxelLevel& level, const std::vector<std::uint32_t>& passes,
                                          const std::vector<TimeBins>& pass_times, const VoxelLevel& drive,
                                          const std::vector<TimeBins>& presence, const SeenThroughOptions& options) {
  return Grading(level, passes, pass_times, drive, presence, options).grades();
}

std::vector<std::uint8_t> are_graded(const std::vector<SeenGrade>& grades) {
  std::vector<std::uint8_t> result;
  for (const SeenGrade grade : grades) result.push_back(grade == SeenGrade::kNot ? 0 : 1);
  return result;
}

std::size_t count_sure(const std::vector<std::size_t>& group, const std::vector<SeenGrade>& grades) {
  return static_cast<std::size_t>(
      std::ranges::count_if(group, [&](std::size_t i) { return grades[i] == SeenGrade::kSure; }));
}

std::vector<std::uint8_t> find_seen_through(const VoxelLevel& level, const std::vector<std::uint32_t>& passes,
                                            const std::vector<TimeBins>& pass_times, const VoxelLevel& drive,
                                            const std::vector<TimeBins>& presence, const SeenThroughOptions& options) {
  const std::vector<SeenGrade> grades = grade_seen_through(level, passes, pass_times, drive, presence, options);
  std::vector<std::uint8_t> result(level.size());
  for (const VoxelGroup& group : find_groups(level, are_graded(grades), kReachOfGroups)) {
    const bool is_whole = goes_whole(count_sure(group, grades), group.size(), options);
    for (const std::size_t member : group) result[member] = is_whole || grades[member] == SeenGrade::kSure;
  }
  return result;
}

}  // namespace vdbmap
