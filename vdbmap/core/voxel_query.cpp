// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_query.h"

#include <sstream>
#include <stdexcept>

#include "vdbmap/core/plain_format.h"
#include "vdbmap/core/srgb.h"

namespace vdbmap {
namespace {

template <typename Value>
std::optional<Value> value_of(const std::vector<Value>& channel, std::size_t number) {
  return channel.empty() ? std::nullopt : std::optional(channel[number]);
}

void set_colors(VoxelInfo& info, const Eigen::Vector3d& linear) {
  info.linear_color = linear;
  info.color = {srgb_from_linear(linear[0]), srgb_from_linear(linear[1]), srgb_from_linear(linear[2])};
}

VoxelInfo decode(const VoxelMap& map, const VoxelLevel& level, const VoxelIndex& voxel, std::size_t number) {
  const VoxelRecord& record = level.records()[number];
  VoxelInfo info;
  info.id = id_of_voxel(voxel);
  info.index = voxel;
  info.voxel_size = level.voxel_size();
  info.count = record.count;
  info.mean = mean_in_original_system(map.frame, record, voxel, level.voxel_size());
  info.covariance = covariance_of(record);
  info.normal = normal_of(record);
  info.planarity = planarity_of(record);
  info.features = eigen_features(info.covariance);
  if (map.has_color) set_colors(info, color_of(record));
  info.intensity = value_of(level.channels().intensities, number);
  info.label = value_of(level.channels().labels, number);
  if (info.label) info.label_name = label_name(map.label_scheme, *info.label);
  info.first_epoch = value_of(level.channels().first_epochs, number);
  info.last_epoch = value_of(level.channels().last_epochs, number);
  return info;
}

std::optional<VoxelInfo> find_voxel(const VoxelMap& map, const VoxelLevel& level, const VoxelIndex& voxel) {
  const VoxelRecord* record = VoxelFinder(level).find(voxel);
  if (!record) return std::nullopt;
  return decode(map, level, voxel, static_cast<std::size_t>(record - level.records().data()));
}

void check_box(const Extent& box) {
  if ((box.min.array() <= box.max.array()).all()) return;
  std::ostringstream message;
  message.precision(12);
  message << "box from " << box.min.transpose().format(kPlainFormat) << " to "
          << box.max.transpose().format(kPlainFormat)
          << ", expected no coordinate of the first corner above the second's";
  throw std::invalid_argument(message.str());
}

// The voxel of a corner of a box, which may lie anywhere.
VoxelIndex voxel_of_corner(const VoxelMap& map, const VoxelLevel& level, const Eigen::Vector3d& corner) {
  const double per_metre = voxels_per_metre(level.voxel_size());
  const double limit = (kIndexLimit + 1) / per_metre;  // one beyond, so that a box outside holds no voxel
  const Eigen::Vector3d local = corner - map.frame.anchor;
  return voxel_of_point(local.cwiseMax(-limit).cwiseMin(limit), per_metre);
}

// Leaves are looked at one by one: at most 80 bytes of memory each.
template <typename Body>
void for_each_leaf_in(const VoxelTree& tree, const openvdb::CoordBBox& box, const Body& body) {
  for (const VoxelLeaf& leaf : tree.leaves()) {
    if (box.hasOverlap(leaf.getNodeBoundingBox())) body(leaf);
  }
}

}  // namespace

std::optional<VoxelInfo> voxel_at(const VoxelMap& map, const VoxelLevel& level, const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = point - map.frame.anchor;
  const double per_metre = voxels_per_metre(level.voxel_size());
  if (!is_addressable(local, per_metre)) return std::nullopt;
  return find_voxel(map, level, voxel_of_point(local, per_metre));
}

std::optional<VoxelInfo> voxel_with_id(const VoxelMap& map, const VoxelLevel& level, VoxelId id) {
  return find_voxel(map, level, voxel_of_id(id));
}

std::vector<VoxelInfo> voxels_in_box(const VoxelMap& map, const VoxelLevel& level, const Extent& box) {
  check_box(box);
  const openvdb::CoordBBox voxels(voxel_of_corner(map, level, box.min), voxel_of_corner(map, level, box.max));
  std::vector<VoxelInfo> found;
  for_each_leaf_in(level.tree(), voxels, [&](const VoxelLeaf& leaf) {
    for_each_voxel(leaf, [&](const VoxelIndex& voxel, std::size_t number) {
      if (voxels.isInside(voxel)) found.push_back(decode(map, level, voxel, number));
    });
  });
  return found;
}

}  // namespace vdbmap
