// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/seen_through.h"

#include <algorithm>
#include <cstddef>

#include "vdbmap/core/option_check.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

constexpr std::int32_t kReachOfPasses = 2;    // voxels around one whose rays count too
constexpr std::int32_t kReachOfPresence = 1;  // voxels around one in which something counts as being there

enum class Grade : std::uint8_t { kNot, kLikely, kSure };

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

  std::vector<Grade> grades() const {
    std::vector<Grade> grades(level_.size());
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
  Grade grade_of(const VoxelIndex& voxel, const VoxelFinder& around, const VoxelFinder& drive) const {
    TimeBins passed;
    std::uint64_t num_rays = 0;
    std::uint64_t num_points = 0;
    around.for_each_around(voxel, kReachOfPasses, [&](const VoxelIndex& /*near*/, const VoxelRecord& record) {
      passed |= pass_times_[number_of(record, level_)];
      num_rays += passes_[number_of(record, level_)];
    });
    if (passed.count() == 0) return Grade::kNot;
    TimeBins there;
    drive.for_each_around(voxel, kReachOfPresence, [&](const VoxelIndex& /*near*/, const VoxelRecord& record) {
      there |= presence_[number_of(record, drive_)];
      num_points += record.count;
    });
    const int num_passed = passed.without(there.widened()).count();
    const double ray_share =
        static_cast<double>(num_rays) / static_cast<double>(std::max<std::uint64_t>(num_rays + num_points, 1));
    if (ray_share < options_.ray_share) return Grade::kNot;
    const double share = num_passed / static_cast<double>(std::max(num_passed + there.count(), 1));
    if (share > options_.sure_share && num_passed >= options_.min_times) return Grade::kSure;
    return share > options_.likely_share ? Grade::kLikely : Grade::kNot;
  }

  const VoxelLevel& level_;
  const std::vector<std::uint32_t>& passes_;
  const std::vector<TimeBins>& pass_times_;
  const VoxelLevel& drive_;
  const std::vector<TimeBins>& presence_;
  const SeenThroughOptions& options_;
};

// Goes through groups of touching voxels that are likely or sure, one after the other.
class GroupWalk {
 public:
  GroupWalk(const VoxelLevel& level, const std::vector<Grade>& grades, double sure_part)
      : level_(level), grades_(grades), sure_part_(sure_part), finder_(level), is_met_(level.size()) {}

  std::vector<std::uint8_t> seen_through() {
    std::vector<std::uint8_t> result(level_.size());
    for_each_voxel(level_, [&](const VoxelIndex& voxel, std::size_t record) {
      if (grades_[record] == Grade::kNot || is_met_[record]) return;
      const std::vector<std::size_t> group = group_from(voxel, record);
      std::size_t num_sure = 0;
      for (const std::size_t member : group) num_sure += grades_[member] == Grade::kSure;
      const bool goes_whole = static_cast<double>(num_sure) >= sure_part_ * static_cast<double>(group.size());
      for (const std::size_t member : group) result[member] = goes_whole || grades_[member] == Grade::kSure;
    });
    return result;
  }

 private:
  std::vector<std::size_t> group_from(const VoxelIndex& voxel, std::size_t record) {
    std::vector<std::size_t> group = {record};
    std::vector<VoxelIndex> voxels = {voxel};
    is_met_[record] = true;
    for (std::size_t next = 0; next < voxels.size(); ++next) {
      const VoxelIndex center = voxels[next];
      finder_.for_each_around(center, 1, [&](const VoxelIndex& near, const VoxelRecord& there) {
        const std::size_t number = number_of(there, level_);
        if (grades_[number] == Grade::kNot || is_met_[number]) return;
        is_met_[number] = true;
        group.push_back(number);
        voxels.push_back(near);
      });
    }
    return group;
  }

  const VoxelLevel& level_;
  const std::vector<Grade>& grades_;
  double sure_part_;
  VoxelFinder finder_;
  std::vector<bool> is_met_;
};

}  // namespace

void SeenThroughOptions::check() const {
  require(sure_share > 0 && sure_share < 1, "sure_share", sure_share, "between 0 and 1");
  require(likely_share > 0 && likely_share <= sure_share, "likely_share", likely_share, "above 0 to sure_share");
  require(sure_part >= 0 && sure_part <= 1, "sure_part", sure_part, "0 to 1");
  require(min_times >= 1 && min_times <= 32, "min_times", min_times, "1 to 32");
}

std::vector<std::uint8_t> find_seen_through(const VoxelLevel& level, const std::vector<std::uint32_t>& passes,
                                            const std::vector<TimeBins>& pass_times, const VoxelLevel& drive,
                                            const std::vector<TimeBins>& presence, const SeenThroughOptions& options) {
  const std::vector<Grade> grades = Grading(level, passes, pass_times, drive, presence, options).grades();
  return GroupWalk(level, grades, options.sure_part).seen_through();
}

}  // namespace vdbmap
