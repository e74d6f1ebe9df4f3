// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/source_points.h"

#include <algorithm>
#include <limits>

#include "vdbmap/core/anchor_choice.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {
namespace {

UnreachablePoints add_cloud(TileSums& sums, const PointCloud& cloud, const Eigen::Isometry3d& local_from_cloud,
                            double per_metre, std::size_t at_once) {
  UnreachablePoints unreachable{0, Eigen::Vector3d::Zero(), kIndexLimit / per_metre};
  for (std::size_t begin = 0; begin < cloud.size(); begin += at_once) {
    const SortedPoints sorted(cloud, begin, std::min(cloud.size(), begin + at_once), local_from_cloud, per_metre);
    if (unreachable.count == 0 && sorted.num_unreachable() > 0) {
      unreachable.first = cloud.positions[sorted.first_unreachable()];
    }
    unreachable.count += sorted.num_unreachable();
    sums.add(sorted);
  }
  return unreachable;
}

// The anchor of an input that is read in one piece.
std::optional<Eigen::Vector3d> anchor_of_whole(const MapInput& input, InputOptions options, double per_metre) {
  options.most_points = std::numeric_limits<std::size_t>::max();
  std::optional<Eigen::Vector3d> anchor;
  read_inputs({input}, options, [&](const InputPoints& points) {
    if (!points.cloud.empty()) anchor = anchor_for(points.cloud, pose_of(input), per_metre);
    return UnreachablePoints();
  });
  return anchor;
}

std::optional<Eigen::Vector3d> find_anchor(const MapInput& input, const InputOptions& options, double per_metre) {
  const Eigen::Isometry3d pose = pose_of(input);
  InputOptions quiet = options;
  quiet.on_scan_done = [] {};
  std::optional<Eigen::Vector3d> near_first;
  std::optional<Eigen::Vector3d> anchor;
  std::size_t num_reached = 0;
  std::size_t num_points = 0;
  read_inputs({input}, quiet, [&](const InputPoints& points) {
    if (points.cloud.empty()) return UnreachablePoints();
    if (points.is_whole) {
      anchor = anchor_for(points.cloud, pose, per_metre);
      return UnreachablePoints();
    }
    if (!near_first) near_first = choose_anchor(pose * points.cloud.positions.front());
    num_points += points.cloud.size();
    num_reached += count_reached(*near_first, points.cloud, pose, per_metre);
    return UnreachablePoints();
  });
  if (!near_first) return anchor;
  if (is_anchor(*near_first) && 2 * num_reached > num_points) return near_first;
  return anchor_of_whole(input, quiet, per_metre);
}

}  // namespace

std::size_t points_at_once(std::size_t memory_bytes) {
  return std::clamp<std::size_t>(memory_bytes / 3 / 250, std::size_t{1} << 14, std::size_t{1} << 21);
}

void PointKinds::add(const PointCloud& cloud) {
  add({!cloud.colors.empty(), !cloud.intensities.empty(), !cloud.labels.empty()});
}

void PointKinds::add(const PointKinds& other) {
  has_color |= other.has_color;
  has_intensity |= other.has_intensity;
  has_labels |= other.has_labels;
}

std::optional<Eigen::Vector3d> anchor_of_source(const MapInput& input, const MapFromFilesOptions& options,
                                                std::size_t memory_bytes) {
  InputOptions inputs = options.inputs;
  inputs.most_points = points_at_once(memory_bytes);
  return find_anchor(input, inputs, voxels_per_metre(options.build.voxel_sizes.front()));
}

CountedPoints count_points(TileSums& sums, const std::vector<MapInput>& inputs, const MapFromFilesOptions& options,
                           std::size_t memory_bytes) {
  const double per_metre = voxels_per_metre(options.build.voxel_sizes.front());
  InputOptions in_pieces = options.inputs;
  in_pieces.most_points = points_at_once(memory_bytes);
  CountedPoints points{options.build.anchor, {}, {}, std::vector<std::uint64_t>(inputs.size(), 0)};
  points.notes = read_inputs(inputs, in_pieces, [&](const InputPoints& read) {
    if (read.cloud.empty()) return UnreachablePoints();
    const MapInput& input = inputs[read.index];
    Eigen::Isometry3d local_from_cloud = pose_of(input);
    if (!points.anchor) {
      points.anchor = read.is_whole ? anchor_for(read.cloud, local_from_cloud, per_metre)
                                    : find_anchor(input, in_pieces, per_metre);
    }
    local_from_cloud.translation() -= *points.anchor;
    points.kinds.add(read.cloud);
    const UnreachablePoints unreachable =
        add_cloud(sums, read.cloud, local_from_cloud, per_metre, in_pieces.most_points);
    points.num_points[read.index] += read.cloud.size() - unreachable.count;
    return unreachable;
  });
  return points;
}

PointKinds count_clouds(TileSums& sums, const CloudSource& clouds, const Eigen::Vector3d& anchor, double voxel_size,
                        std::size_t memory_bytes) {
  const double per_metre = voxels_per_metre(voxel_size);
  PointKinds kinds;
  clouds([&](const PosedCloud& posed) {
    if (posed.cloud.empty()) return;
    Eigen::Isometry3d local_from_cloud = posed.map_from_cloud;
    local_from_cloud.translation() -= anchor;
    kinds.add(posed.cloud);
    check_reached(add_cloud(sums, posed.cloud, local_from_cloud, per_metre, points_at_once(memory_bytes)),
                  posed.cloud.size());
  });
  return kinds;
}

CityLayout layout_of_points(const Eigen::Vector3d& anchor, const PointKinds& kinds, const InputNotes& notes,
                            const BuildOptions& build, float density) {
  CityLayout layout;
  layout.frame = {anchor, build.epsg ? build.epsg : notes.epsg_of_files};
  layout.voxel_sizes = exact_voxel_sizes(build.voxel_sizes);
  layout.has_color = kinds.has_color;
  if (kinds.has_intensity) layout.channels.emplace_back("intensity");
  if (kinds.has_labels) layout.channels.emplace_back("label");
  if (build.epoch) layout.channels.insert(layout.channels.end(), {"first_epoch", "last_epoch"});
  layout.label_scheme = notes.label_scheme;
  layout.density = density;
  return layout;
}

}  // namespace vdbmap
