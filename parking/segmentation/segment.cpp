// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/segment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "parking/segmentation/network.h"
#include "parking/segmentation/vehicle_size.h"
#include "parking/segmentation/voxel_features.h"
#include "parking/segmentation/voxel_pyramid.h"
#include "vdbmap/core/hierarchy.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/point_cell.h"

namespace vdbmap::parking {
namespace {

constexpr double kSize = 0.1;          // [m] of the voxels that the network knows
constexpr std::int32_t kTile = 640;    // [voxels]: a whole number of voxels of every level
constexpr std::int32_t kMargin = 240;  // [voxels]: neighbours of all levels and columns of the features reach 22 m

using Box = openvdb::CoordBBox;

// Of each voxel the class that scores highest, and the one after it.
struct Ranked {
  std::vector<SurfaceClass> first;
  std::vector<SurfaceClass> second;

  explicit Ranked(std::size_t size) : first(size), second(size) {}
};

Ranked segment_at_once(const VoxelLevel& finest, const NetworkWeights& network) {
  Rows scores = class_scores(network, make_pyramid(finest), voxel_features(finest));
  Ranked ranked(finest.size());
  for (std::size_t i = 0; i < finest.size(); ++i) {
    auto row = scores.row(static_cast<Eigen::Index>(i));
    Eigen::Index best = 0;
    row.maxCoeff(&best);
    ranked.first[i] = static_cast<SurfaceClass>(best);
    row[best] = std::numeric_limits<float>::lowest();
    row.maxCoeff(&best);
    ranked.second[i] = static_cast<SurfaceClass>(best);
  }
  return ranked;
}

std::size_t num_voxels(const VoxelLevel& level, const Box& box) {
  std::size_t count = 0;
  for (const VoxelLeaf& leaf : level.leaves()) {
    if (box.isInside(leaf.origin())) count += leaf.getValueMask().countOn();
  }
  return count;
}

// Halves a box of whole tiles, along its longer side, until each part has few voxels or is a tile.
void split(const VoxelLevel& level, const Box& box, std::size_t most, std::vector<Box>& windows) {
  const std::size_t count = num_voxels(level, box);
  if (count == 0) return;
  const VoxelIndex size = box.dim();
  const int axis = size.x() >= size.y() ? 0 : 1;
  const std::int32_t num_tiles = size[axis] / kTile;
  if (count <= most || num_tiles < 2) {
    windows.push_back(box);
    return;
  }
  Box low = box, high = box;
  high.min()[axis] = box.min()[axis] + num_tiles / 2 * kTile;
  low.max()[axis] = high.min()[axis] - 1;
  split(level, low, most, windows);
  split(level, high, most, windows);
}

// Whole tiles around all voxels, from the lowest voxel to the highest.
Box box_of_tiles(const VoxelLevel& level) {
  Box box = level.tree().voxel_box();
  for (const int axis : {0, 1}) {
    box.min()[axis] = floor_divide(box.min()[axis], kTile) * kTile;
    box.max()[axis] = (floor_divide(box.max()[axis], kTile) + 1) * kTile - 1;
  }
  box.min().z() &= ~7;  // leaves are told by their lowest voxel
  return box;
}

void segment_window(const VoxelLevel& finest, const NetworkWeights& network, const Box& window, Ranked& ranked) {
  Box seen = window;
  for (const int axis : {0, 1}) {
    seen.min()[axis] -= kMargin;
    seen.max()[axis] += kMargin;
  }
  const VoxelLevel part = cut_leaves(finest, seen);
  const Ranked found = segment_at_once(part, network);
  for (const VoxelLeaf& leaf : part.leaves()) {
    if (!window.isInside(leaf.origin())) continue;
    const auto from = static_cast<std::ptrdiff_t>(leaf.transientData());
    const auto to = static_cast<std::ptrdiff_t>(finest.tree().find_leaf(leaf.origin())->transientData());
    const auto count = leaf.getValueMask().countOn();
    std::copy_n(found.first.begin() + from, count, ranked.first.begin() + to);
    std::copy_n(found.second.begin() + from, count, ranked.second.begin() + to);
  }
}

Ranked segment_in_windows(const VoxelLevel& finest, const NetworkWeights& network, std::size_t most) {
  std::vector<Box> windows;
  split(finest, box_of_tiles(finest), most, windows);
  Ranked ranked(finest.size());
  for (const Box& window : windows) segment_window(finest, network, window, ranked);
  return ranked;
}

void check_size(const VoxelLevel& level) {
  if (std::abs(level.voxel_size() - kSize) > 1e-9) {
    throw std::invalid_argument("voxels are segmented at 0.1 m");
  }
}

std::vector<std::int32_t> labels_of(const std::vector<SurfaceClass>& classes) {
  std::vector<std::int32_t> labels(classes.size());
  std::ranges::transform(classes, labels.begin(), semantic_kitti_label);
  return labels;
}

// Each voxel has the label of its parent.
std::vector<std::int32_t> labels_from_parents(const VoxelLevel& fine, const VoxelLevel& parents, std::int32_t factor,
                                              const std::vector<std::int32_t>& labels) {
  std::vector<std::int32_t> result(fine.size());
  const VoxelFinder finder(parents);
  for_each_voxel(fine, [&](const VoxelIndex& voxel, std::size_t number) {
    const VoxelRecord* parent = finder.find(parent_of_voxel(voxel, factor));
    result[number] = labels[static_cast<std::size_t>(parent - parents.records().data())];
  });
  return result;
}

}  // namespace

std::vector<SurfaceClass> segment(const VoxelLevel& finest, const NetworkWeights& network,
                                  const SegmentOptions& options) {
  check_size(finest);
  Ranked ranked = finest.size() <= options.voxels_at_once ? segment_at_once(finest, network)
                                                          : segment_in_windows(finest, network, options.voxels_at_once);
  drop_what_is_no_vehicle(finest, ranked.second, ranked.first);
  return std::move(ranked.first);
}

void label_map(VoxelMap& map, const NetworkWeights& network, const SegmentOptions& options) {
  VoxelLevel& finest = map.levels.front();
  const double factor = std::round(kSize / finest.voxel_size());
  if (factor < 1 || std::abs(factor * finest.voxel_size() - kSize) > 1e-9) {
    throw std::invalid_argument("voxels are segmented at 0.1 m, of which the map's finest voxels are no whole part");
  }
  const auto whole_factor = static_cast<std::int32_t>(factor);
  if (whole_factor == 1) {
    finest.channels().labels = labels_of(segment(finest, network, options));
  } else {
    const VoxelLevel level = coarsen(finest, whole_factor);
    finest.channels().labels =
        labels_from_parents(finest, level, whole_factor, labels_of(segment(level, network, options)));
  }
  map.label_scheme = LabelScheme::kSemanticKitti;
  for (std::size_t i = 1; i < map.levels.size(); ++i) {
    const VoxelLevel& below = map.levels[i - 1];
    VoxelLevel above = coarsen(below, level_factor(below.voxel_size(), map.levels[i].voxel_size()));
    map.levels[i].channels().labels = std::move(above.channels().labels);
  }
}

std::vector<std::int32_t> point_labels(const PointCloud& cloud, const NetworkWeights& network,
                                       const SegmentOptions& options) {
  BuildOptions build;
  build.voxel_sizes = {kSize};
  const VoxelMap map = build_map(cloud, build);
  const std::vector<std::int32_t> of_voxels = labels_of(segment(map.finest(), network, options));
  const CellFinder cells(Eigen::Isometry3d(Eigen::Translation3d(-map.frame.anchor)), voxels_per_metre(kSize));
  std::vector<std::int32_t> labels(cloud.size(), kNoLabel);
  parallel_ranges(cloud.size(), 1024, [&](std::size_t begin, std::size_t end) {
    const VoxelFinder finder(map.finest());
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<PointCell> cell = cells.find(cloud.positions[i]);
      const VoxelRecord* record = cell ? finder.find(cell->voxel) : nullptr;
      if (record != nullptr) labels[i] = of_voxels[static_cast<std::size_t>(record - map.finest().records().data())];
    }
  });
  return labels;
}

}  // namespace vdbmap::parking
