// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/map_merge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/label_votes.h"
#include "vdbmap/core/normals.h"
#include "vdbmap/core/plain_format.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// A voxel of the merged map and its records in the two maps.
struct VoxelPair {
  VoxelKey key;
  VoxelIndex voxel;
  std::uint32_t in_a = kNone;
  std::uint32_t in_b = kNone;
};

std::string sizes_text(const VoxelMap& map) {
  std::ostringstream text;
  for (const VoxelLevel& level : map.levels) text << (&level == &map.finest() ? "" : ", ") << level.voxel_size();
  return map.levels.empty() ? "no" : text.str();
}

void check_same_levels(const VoxelMap& a, const VoxelMap& b) {
  const auto same_size = [](const VoxelLevel& x, const VoxelLevel& y) {
    return std::abs(x.voxel_size() - y.voxel_size()) < 1e-9;
  };
  if (!a.levels.empty() && std::ranges::equal(a.levels, b.levels, same_size)) return;
  throw std::invalid_argument("maps with levels of " + sizes_text(a) + " m and of " + sizes_text(b) +
                              " m cannot be merged");
}

MapFrame merged_frame(const VoxelMap& a, const VoxelMap& b) {
  const std::optional<int> epsg_a = a.frame.epsg;
  const std::optional<int> epsg_b = b.frame.epsg;
  if (epsg_a && epsg_b && *epsg_a != *epsg_b) {
    throw std::invalid_argument("maps of EPSG:" + std::to_string(*epsg_a) + " and EPSG:" + std::to_string(*epsg_b) +
                                " cannot be merged");
  }
  return {a.finest().size() > 0 ? a.frame.anchor : b.frame.anchor, epsg_a ? epsg_a : epsg_b};
}

bool has_labels(const VoxelMap& map) { return !map.finest().channels().labels.empty(); }

// Where one map does not say whose numbers its labels are, nobody can say it of both.
LabelScheme merged_scheme(const VoxelMap& a, const VoxelMap& b) {
  if (!has_labels(a) || !has_labels(b)) return has_labels(a) ? a.label_scheme : b.label_scheme;
  if (a.label_scheme == b.label_scheme) return a.label_scheme;
  if (a.label_scheme == LabelScheme::kUnknown || b.label_scheme == LabelScheme::kUnknown) return LabelScheme::kUnknown;
  throw std::invalid_argument("maps with labels of " + std::string(text_of(a.label_scheme)) + " and of " +
                              std::string(text_of(b.label_scheme)) + " cannot be merged");
}

[[noreturn]] void throw_unreachable(const MapFrame& from, const MapFrame& to, double voxel_size) {
  std::ostringstream message;
  message.precision(12);
  message << "a voxel of the map with anchor " << from.anchor.transpose().format(kPlainFormat) << " is more than "
          << kIndexLimit * voxel_size << " m from the anchor " << to.anchor.transpose().format(kPlainFormat)
          << ", the farthest that voxel ids reach";
  throw std::out_of_range(message.str());
}

// What is added to voxel indices of one frame to have them in another: whole, as anchors are whole tiles.
std::array<double, 3> shift_between(const MapFrame& from, const MapFrame& to, double voxel_size) {
  const Eigen::Vector3d voxels = (from.anchor - to.anchor) * voxels_per_metre(voxel_size);
  return {std::round(voxels.x()), std::round(voxels.y()), std::round(voxels.z())};
}

// The voxels of a map's finest level in another frame, sorted; `record` receives the number of each one's record.
std::vector<VoxelPair> list_voxels(const VoxelMap& map, const MapFrame& frame, std::uint32_t VoxelPair::*record) {
  const VoxelLevel& level = map.finest();
  const std::array<double, 3> shift = shift_between(map.frame, frame, level.voxel_size());
  std::vector<VoxelPair> voxels;
  voxels.reserve(level.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const Eigen::Vector3d shifted(voxel.x() + shift[0], voxel.y() + shift[1], voxel.z() + shift[2]);
    if (!is_addressable(shifted, 1.0)) throw_unreachable(map.frame, frame, level.voxel_size());
    const VoxelIndex index = voxel_of_point(shifted, 1.0);
    VoxelPair& pair = voxels.emplace_back(VoxelPair{key_of_voxel(index), index});
    pair.*record = static_cast<std::uint32_t>(number);
  });
  parallel_sort(voxels, [](const VoxelPair& x, const VoxelPair& y) { return x.key < y.key; });
  return voxels;
}

// Union of two sorted lists; a voxel of both appears once, with both records.
std::vector<VoxelPair> pair_voxels(const std::vector<VoxelPair>& a, const std::vector<VoxelPair>& b) {
  std::vector<VoxelPair> pairs;
  pairs.reserve(a.size() + b.size());
  auto next_b = b.begin();
  for (const VoxelPair& voxel : a) {
    while (next_b != b.end() && next_b->key < voxel.key) pairs.push_back(*next_b++);
    pairs.push_back(voxel);
    if (next_b != b.end() && next_b->key == voxel.key) pairs.back().in_b = (next_b++)->in_b;
  }
  pairs.insert(pairs.end(), next_b, b.end());
  return pairs;
}

Eigen::Vector3d merged_color(const VoxelRecord& a, const VoxelRecord& b) {
  const double count_a = a.count;
  const double count_b = b.count;
  return (count_a * color_of(a) + count_b * color_of(b)) / (count_a + count_b);
}

// Sums of doubles depend on their order: the smaller record always comes first.
bool comes_before(const VoxelRecord& x, const VoxelRecord& y) {
  return std::tie(x.count, x.mean_code, x.covariance) < std::tie(y.count, y.mean_code, y.covariance);
}

// Moments are merged about the voxel's own corner, so that the result does not depend on the anchor.
VoxelRecord merged_record(const VoxelRecord& a, const VoxelRecord& b, double voxel_size) {
  const auto& [first, second] = comes_before(b, a) ? std::tie(b, a) : std::tie(a, b);
  const VoxelIndex corner(0, 0, 0);
  VoxelRecord merged;
  set_moments(merged, merge(moments_of(first, corner, voxel_size), moments_of(second, corner, voxel_size)), corner,
              voxel_size);
  return merged;
}

// Merges the finest levels of two maps, attribute by attribute.
class LevelMerger {
 public:
  LevelMerger(const VoxelMap& a, const VoxelMap& b, std::vector<VoxelPair> pairs)
      : a_(a), b_(b), pairs_(std::move(pairs)) {}

  VoxelLevel merge_level() const {
    VoxelAssembly assembly(a_.finest().voxel_size(), pairs_.size());
    for (const VoxelPair& pair : pairs_) {
      [[maybe_unused]] const bool in_order = assembly.add(pair.voxel, record_of(pair));
    }
    assembly.channels() = merge_channels();
    VoxelLevel level = assembly.finish();
    compute_normals(level);
    return level;
  }

 private:
  const VoxelRecord& record_a(const VoxelPair& pair) const { return a_.finest().records()[pair.in_a]; }
  const VoxelRecord& record_b(const VoxelPair& pair) const { return b_.finest().records()[pair.in_b]; }

  VoxelRecord record_of(const VoxelPair& pair) const {
    if (pair.in_b == kNone) return record_a(pair);
    if (pair.in_a == kNone) return record_b(pair);
    const VoxelRecord& a = record_a(pair);
    const VoxelRecord& b = record_b(pair);
    VoxelRecord merged = merged_record(a, b, a_.finest().voxel_size());
    const bool are_alike = a_.has_color == b_.has_color;
    set_color(merged, are_alike ? merged_color(a, b) : color_of(a_.has_color ? a : b));
    return merged;
  }

  float mean_intensity(const VoxelPair& pair) const {
    using Share = std::pair<double, double>;  // points and their mean intensity
    const Share a(record_a(pair).count, a_.finest().channels().intensities[pair.in_a]);
    const Share b(record_b(pair).count, b_.finest().channels().intensities[pair.in_b]);
    const auto& [first, second] = std::minmax(a, b);
    return static_cast<float>(first.second +
                              second.first / (first.first + second.first) * (second.second - first.second));
  }

  // Of two voters, each with all its points.
  std::int32_t winning_label(const VoxelPair& pair) const {
    std::vector<LabelVotes> votes;
    add_vote(votes, pair.key, a_.finest().channels().labels[pair.in_a], record_a(pair).count);
    add_vote(votes, pair.key, b_.finest().channels().labels[pair.in_b], record_b(pair).count);
    sort_votes(votes);
    return LabelElection(votes).winner(pair.key);
  }

  // One value a voxel: of the map that has one, or of both as `combine` makes it.
  template <typename Value, typename Combine>
  std::vector<Value> merge_channel(std::vector<Value> VoxelChannels::*channel, const Combine& combine) const {
    const std::vector<Value>& a = a_.finest().channels().*channel;
    const std::vector<Value>& b = b_.finest().channels().*channel;
    std::vector<Value> merged;
    if (a.empty() && b.empty()) return merged;
    merged.reserve(pairs_.size());
    for (const VoxelPair& pair : pairs_) {
      const bool known_to_a = pair.in_a != kNone && !a.empty();
      const bool known_to_b = pair.in_b != kNone && !b.empty();
      if (known_to_a && known_to_b) {
        merged.push_back(combine(pair));
      } else {
        merged.push_back(known_to_a ? a[pair.in_a] : known_to_b ? b[pair.in_b] : Value{});
      }
    }
    return merged;
  }

  VoxelChannels merge_channels() const {
    const VoxelChannels& a = a_.finest().channels();
    const VoxelChannels& b = b_.finest().channels();
    VoxelChannels merged;
    merged.intensities =
        merge_channel(&VoxelChannels::intensities, [&](const VoxelPair& pair) { return mean_intensity(pair); });
    merged.labels = merge_channel(&VoxelChannels::labels, [&](const VoxelPair& pair) { return winning_label(pair); });
    merged.first_epochs = merge_channel(&VoxelChannels::first_epochs, [&](const VoxelPair& pair) {
      return std::min(a.first_epochs[pair.in_a], b.first_epochs[pair.in_b]);
    });
    merged.last_epochs = merge_channel(&VoxelChannels::last_epochs, [&](const VoxelPair& pair) {
      return std::max(a.last_epochs[pair.in_a], b.last_epochs[pair.in_b]);
    });
    return merged;
  }

  const VoxelMap& a_;
  const VoxelMap& b_;
  std::vector<VoxelPair> pairs_;
};

}  // namespace

VoxelMap merge_maps(const VoxelMap& a, const VoxelMap& b) {
  check_same_levels(a, b);
  VoxelMap merged;
  merged.frame = merged_frame(a, b);
  merged.has_color = a.has_color || b.has_color;
  merged.label_scheme = merged_scheme(a, b);

  std::vector<VoxelPair> pairs =
      pair_voxels(list_voxels(a, merged.frame, &VoxelPair::in_a), list_voxels(b, merged.frame, &VoxelPair::in_b));
  merged.levels.push_back(LevelMerger(a, b, std::move(pairs)).merge_level());

  std::vector<double> voxel_sizes;
  for (const VoxelLevel& level : a.levels) voxel_sizes.push_back(level.voxel_size());
  add_coarser_levels(merged, voxel_sizes);
  return merged;
}

}  // namespace vdbmap
