// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/change/map_diff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "vdbmap/change/placement.h"
#include "vdbmap/change/voxel_judge.h"
#include "vdbmap/core/option_check.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

constexpr int kFewestNeighbors = 2;  // of any change, that a change has around it
constexpr double kConfidenceSteps = 255;
constexpr std::size_t kLeavesAtOnce = 64;

// A judgement in two bytes.
struct Code {
  std::uint8_t change = 0;
  std::uint8_t confidence = 0;
};

Code code_of(const Judgement& judgement) {
  return {static_cast<std::uint8_t>(judgement.change),
          static_cast<std::uint8_t>(std::lround(kConfidenceSteps * std::clamp(judgement.confidence, 0.0, 1.0)))};
}

bool is_change(Code code) {
  const auto change = static_cast<Change>(code.change);
  return change == Change::kAppeared || change == Change::kVanished || change == Change::kChanged;
}

// A voxel of the diff and the record of the map that it is of.
struct FoundVoxel {
  VoxelKey key;
  VoxelRecord record;
  std::int32_t label;
  std::uint8_t confidence;
};

// What was found in a map or a part of it.
struct FoundVoxels {
  std::array<std::vector<FoundVoxel>, 4> by_change;  // appeared, vanished and changed at their numbers
  std::vector<VoxelLeaf> unobserved;
  ChangeCounts counts;

  std::vector<FoundVoxel>& of(Change change) { return by_change[static_cast<std::size_t>(change)]; }

  void append(const FoundVoxels& part) {
    for (std::size_t i = 0; i < by_change.size(); ++i) {
      by_change[i].insert(by_change[i].end(), part.by_change[i].begin(), part.by_change[i].end());
    }
    unobserved.insert(unobserved.end(), part.unobserved.begin(), part.unobserved.end());
    counts.add(part.counts);
  }
};

std::uint64_t& count_of(ChangeCounts& counts, Change change) {
  switch (change) {
    case Change::kAppeared:
      return counts.appeared;
    case Change::kVanished:
      return counts.vanished;
    case Change::kChanged:
      return counts.changed;
    case Change::kUnobserved:
      return counts.unobserved;
    case Change::kUnchanged:
      break;
  }
  return counts.unchanged;
}

// A map that is compared with another, and what its voxels lie in of the diff's frame.
struct Subject {
  const SeenMap& map;
  const SeenMap& other;
  const Placement& placement;
  VoxelIndex diff_from_subject;
  bool is_later;
};

// The box and the voxels beside it.
openvdb::CoordBBox with_neighbors(openvdb::CoordBBox box) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min()[axis] = std::max(box.min()[axis], std::numeric_limits<std::int32_t>::min() + 1) - 1;
    box.max()[axis] = std::min(box.max()[axis], std::numeric_limits<std::int32_t>::max() - 1) + 1;
  }
  return box;
}

bool touches(const openvdb::CoordBBox& box, const VoxelIndex& leaf) {
  return box.hasOverlap(openvdb::CoordBBox::createCube(leaf, VoxelLeaf::DIM));
}

// The judgements of all voxels in leaves of the box and beside it.
std::vector<Code> judge_level(const Subject& subject, const openvdb::CoordBBox& box, const SignificanceLimits& limits,
                              const DiffOptions& options) {
  const VoxelLevel& level = subject.map.map.finest();
  std::vector<Code> codes(level.size());
  const openvdb::CoordBBox reached = with_neighbors(box);
  parallel_ranges(level.leaves().size(), kLeavesAtOnce, [&](std::size_t begin, std::size_t end) {
    const VoxelJudge judge(subject.map, subject.other, subject.placement, limits, options.takes_unseen_as_empty);
    for (std::size_t i = begin; i < end; ++i) {
      const VoxelLeaf& leaf = level.leaves()[i];
      if (!touches(reached, leaf.origin() + subject.diff_from_subject)) continue;
      for_each_voxel(leaf, [&](const VoxelIndex& voxel, std::size_t record) {
        const bool is_of_other =
            !subject.is_later && judge.counterpart(subject.placement.other_voxel(voxel, level.records()[record]));
        if (!is_of_other) codes[record] = code_of(judge.judge(voxel, record));
      });
    }
  });
  return codes;
}

// Whether enough is around a voxel that changed too: sensors make single voxels of edges.
bool has_support(const VoxelLevel& level, const VoxelFinder& finder, const std::vector<Code>& codes,
                 const VoxelIndex& voxel) {
  int count = -1;  // the voxel itself
  finder.for_each_around(voxel, 1, [&](const VoxelIndex&, const VoxelRecord& record) {
    count += is_change(codes[static_cast<std::size_t>(&record - level.records().data())]) ? 1 : 0;
  });
  return count >= kFewestNeighbors;
}

FoundVoxel found_voxel(const Subject& subject, const VoxelIndex& voxel, std::size_t record, Code code) {
  const VoxelLevel& level = subject.map.map.finest();
  const auto& labels = level.channels().labels;
  return {key_of_voxel(voxel + subject.diff_from_subject), level.records()[record],
          labels.empty() ? kNoLabel : labels[record], code.confidence};
}

// Collects what was found, leaf by leaf.
class Collector {
 public:
  Collector(const Subject& subject, const std::vector<Code>& codes)
      : subject_(subject),
        codes_(codes),
        level_(subject.map.map.finest()),
        finder_(level_),
        counterparts_(subject.other.map.finest()) {}

  void add_leaf(const VoxelLeaf& leaf, FoundVoxels& found) const {
    VoxelLeaf unobserved(leaf.origin() + subject_.diff_from_subject, false);
    for_each_voxel(leaf, [&](const VoxelIndex& voxel, std::size_t record) {
      if (is_counted_with_other(voxel, record)) return;
      const Change change = change_of(voxel, record);
      ++count_of(found.counts, change);
      if (change == Change::kUnchanged || !is_addressable(voxel + subject_.diff_from_subject)) return;
      if (change == Change::kUnobserved) {
        unobserved.setValueOn(voxel + subject_.diff_from_subject);
      } else {
        found.of(change).push_back(found_voxel(subject_, voxel, record, codes_[record]));
      }
    });
    if (!unobserved.isEmpty()) found.unobserved.push_back(unobserved);
  }

 private:
  bool is_counted_with_other(const VoxelIndex& voxel, std::size_t record) const {
    return !subject_.is_later &&
           counterparts_.find(subject_.placement.other_voxel(voxel, level_.records()[record])) != nullptr;
  }

  Change change_of(const VoxelIndex& voxel, std::size_t record) const {
    const auto change = static_cast<Change>(codes_[record].change);
    if (is_change(codes_[record]) && !has_support(level_, finder_, codes_, voxel)) return Change::kUnchanged;
    return change == Change::kAppeared && !subject_.is_later ? Change::kVanished : change;
  }

  const Subject& subject_;
  const std::vector<Code>& codes_;
  const VoxelLevel& level_;
  VoxelFinder finder_;
  VoxelFinder counterparts_;
};

FoundVoxels compare(const Subject& subject, const openvdb::CoordBBox& box, const SignificanceLimits& limits,
                    const DiffOptions& options) {
  const std::vector<Code> codes = judge_level(subject, box, limits, options);
  const std::span<const VoxelLeaf> leaves = subject.map.map.finest().leaves();
  std::vector<FoundVoxels> parts((leaves.size() + kLeavesAtOnce - 1) / kLeavesAtOnce);
  parallel_for(parts.size(), [&](std::size_t part) {
    const Collector collector(subject, codes);
    const std::size_t end = std::min(leaves.size(), (part + 1) * kLeavesAtOnce);
    for (std::size_t i = part * kLeavesAtOnce; i < end; ++i) {
      if (box.isInside(leaves[i].origin() + subject.diff_from_subject)) collector.add_leaf(leaves[i], parts[part]);
    }
  });
  FoundVoxels all;
  for (const FoundVoxels& part : parts) all.append(part);
  return all;
}

// Sorted, and of several voxels of one place the first.
void sort_by_key(std::vector<FoundVoxel>& voxels) {
  std::ranges::stable_sort(voxels, {}, &FoundVoxel::key);
  const auto first = std::unique(voxels.begin(), voxels.end(),
                                 [](const FoundVoxel& a, const FoundVoxel& b) { return a.key == b.key; });
  voxels.erase(first, voxels.end());
}

ChangedVoxels voxels_of(std::vector<FoundVoxel> found, double voxel_size, bool has_labels) {
  sort_by_key(found);
  VoxelAssembly assembly(voxel_size, found.size());
  ChangedVoxels result{{voxel_size, {}, {}}, {}};
  for (const FoundVoxel& voxel : found) {
    [[maybe_unused]] const bool in_order = assembly.add(voxel_of_key(voxel.key), voxel.record);
    if (has_labels) assembly.channels().labels.push_back(voxel.label);
    result.confidences.push_back(static_cast<float>(voxel.confidence / kConfidenceSteps));
  }
  result.level = assembly.finish();
  return result;
}

VoxelKey key_of_leaf(const VoxelLeaf& leaf) { return key_of_voxel(leaf.origin()); }

VoxelTree tree_of(std::vector<VoxelLeaf> leaves) {
  std::ranges::stable_sort(leaves, {}, key_of_leaf);
  LargeVector<VoxelLeaf> joined;
  for (const VoxelLeaf& leaf : leaves) {
    if (joined.empty() || joined.back().origin() != leaf.origin()) {
      joined.push_back(leaf);
    } else {
      joined.back().setValueMask(joined.back().getValueMask() | leaf.getValueMask());
    }
  }
  return VoxelTree(std::move(joined));
}

void check_comparable(const SeenMap& map) {
  if (map.map.levels.empty()) throw std::invalid_argument("a map without levels cannot be compared");
  if (!map.visibility) return;
  const bool is_of_map = map.visibility->voxel_size == map.map.finest().voxel_size() &&
                         map.visibility->hits.size() == map.map.finest().size() &&
                         map.visibility->passes.size() == map.map.finest().size();
  if (!is_of_map) throw std::invalid_argument("what rays saw belongs to another map");
}

void check_alike(const VoxelMap& earlier, const VoxelMap& later) {
  const double a = earlier.finest().voxel_size(), b = later.finest().voxel_size();
  if (std::abs(a - b) >= 1e-9) {
    std::ostringstream message;
    message << "maps with voxels of " << a << " m and of " << b << " m cannot be compared";
    throw std::invalid_argument(message.str());
  }
  const auto &epsg_a = earlier.frame.epsg, &epsg_b = later.frame.epsg;
  if (epsg_a && epsg_b && *epsg_a != *epsg_b) {
    throw std::invalid_argument("maps of EPSG:" + std::to_string(*epsg_a) + " and EPSG:" + std::to_string(*epsg_b) +
                                " cannot be compared");
  }
}

bool has_labels(const VoxelMap& map) { return !map.finest().channels().labels.empty(); }

// Whose numbers the labels of the diff are: of two maps that disagree, nobody can say it.
LabelScheme common_scheme(const VoxelMap& earlier, const VoxelMap& later) {
  if (!has_labels(earlier) || !has_labels(later)) return has_labels(later) ? later.label_scheme : earlier.label_scheme;
  return earlier.label_scheme == later.label_scheme ? later.label_scheme : LabelScheme::kUnknown;
}

// Drops voxels where another kind has one: a map that was moved lies across the voxels of the other.
void drop_voxels_of(const VoxelLevel& level, std::vector<FoundVoxel>& voxels) {
  const VoxelFinder finder(level);
  std::erase_if(voxels, [&](const FoundVoxel& voxel) { return finder.find(voxel_of_key(voxel.key)) != nullptr; });
}

MapDiff diff_of(FoundVoxels found, const VoxelMap& earlier, const VoxelMap& later) {
  const double voxel_size = later.finest().voxel_size();
  ChangedVoxels appeared = voxels_of(std::move(found.of(Change::kAppeared)), voxel_size, has_labels(later));
  drop_voxels_of(appeared.level, found.of(Change::kChanged));
  ChangedVoxels changed =
      voxels_of(std::move(found.of(Change::kChanged)), voxel_size, has_labels(earlier) || has_labels(later));
  drop_voxels_of(appeared.level, found.of(Change::kVanished));
  drop_voxels_of(changed.level, found.of(Change::kVanished));
  ChangedVoxels vanished = voxels_of(std::move(found.of(Change::kVanished)), voxel_size, has_labels(earlier));
  return {.frame = {later.frame.anchor, later.frame.epsg ? later.frame.epsg : earlier.frame.epsg},
          .label_scheme = common_scheme(earlier, later),
          .counts = found.counts,
          .appeared = std::move(appeared),
          .vanished = std::move(vanished),
          .changed = std::move(changed),
          .unobserved = tree_of(std::move(found.unobserved))};
}

void list_voxels(const ChangedVoxels& voxels, std::vector<FoundVoxel>& list) {
  const std::vector<std::int32_t>& labels = voxels.level.channels().labels;
  for_each_voxel(voxels.level, [&](const VoxelIndex& voxel, std::size_t record) {
    list.push_back({key_of_voxel(voxel), voxels.level.records()[record], labels.empty() ? kNoLabel : labels[record],
                    static_cast<std::uint8_t>(std::lround(kConfidenceSteps * voxels.confidences[record]))});
  });
}

}  // namespace

const char* name_of(Change change) {
  constexpr std::array kNames = {"unchanged", "appeared", "vanished", "changed", "unobserved"};
  return kNames[static_cast<std::size_t>(change)];
}

void DiffOptions::check() const {
  require(pose_sigma >= 0 && pose_sigma <= 10, "pose_sigma", pose_sigma, "0 to 10 m");
  require(range_sigma >= 0 && range_sigma <= 10, "range_sigma", range_sigma, "0 to 10 m");
  require(significance > 0 && significance <= 0.5, "significance", significance, "more than 0 and at most 0.5");
  if (!earlier_from_later.matrix().allFinite())
    throw std::invalid_argument("the motion between the maps is not finite");
}

void ChangeCounts::add(const ChangeCounts& other) {
  appeared += other.appeared;
  vanished += other.vanished;
  changed += other.changed;
  unchanged += other.unchanged;
  unobserved += other.unobserved;
}

MapDiff map_diff(const SeenMap& earlier, const SeenMap& later, const DiffOptions& options) {
  return map_diff_in(openvdb::CoordBBox::inf(), earlier, later, options);
}

MapDiff map_diff_in(const openvdb::CoordBBox& box, const SeenMap& earlier, const SeenMap& later,
                    const DiffOptions& options) {
  options.check();
  check_comparable(earlier);
  check_comparable(later);
  check_alike(earlier.map, later.map);
  const double voxel_size = later.map.finest().voxel_size();
  const SignificanceLimits limits(options.pose_sigma, options.range_sigma, options.significance);
  const Placement to_earlier(later.map.frame, earlier.map.frame, options.earlier_from_later, voxel_size);
  const Placement to_later(earlier.map.frame, later.map.frame, options.earlier_from_later.inverse(), voxel_size);
  FoundVoxels found = compare({later, earlier, to_earlier, VoxelIndex(0), true}, box, limits, options);
  found.append(compare({earlier, later, to_later, to_later.shift(), false}, box, limits, options));

  return diff_of(std::move(found), earlier.map, later.map);
}

MapDiff join_diffs(const std::vector<MapDiff>& diffs) {
  if (diffs.empty()) throw std::invalid_argument("no diffs to join");
  const double voxel_size = diffs.front().voxel_size();
  FoundVoxels all;
  std::array<bool, 4> knows_labels{};
  for (const MapDiff& diff : diffs) {
    all.counts.add(diff.counts);
    const auto add = [&](Change change, const ChangedVoxels& voxels) {
      list_voxels(voxels, all.of(change));
      knows_labels[static_cast<std::size_t>(change)] |= !voxels.level.channels().labels.empty();
    };
    add(Change::kAppeared, diff.appeared);
    add(Change::kVanished, diff.vanished);
    add(Change::kChanged, diff.changed);
    all.unobserved.insert(all.unobserved.end(), diff.unobserved.leaves().begin(), diff.unobserved.leaves().end());
  }
  return {.frame = diffs.front().frame,
          .label_scheme = diffs.front().label_scheme,
          .counts = all.counts,
          .appeared = voxels_of(std::move(all.of(Change::kAppeared)), voxel_size, knows_labels[1]),
          .vanished = voxels_of(std::move(all.of(Change::kVanished)), voxel_size, knows_labels[2]),
          .changed = voxels_of(std::move(all.of(Change::kChanged)), voxel_size, knows_labels[3]),
          .unobserved = tree_of(std::move(all.unobserved))};
}

}  // namespace vdbmap
