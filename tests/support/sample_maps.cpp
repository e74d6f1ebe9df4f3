// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/sample_maps.h"

#include <algorithm>
#include <cstring>
#include <random>

#include "tests/support/random_points.h"

namespace vdbmap::test {
namespace {

const Eigen::Vector3d kAnchor(550016, 5804992, 64);  // multiples of 64 m

// Clusters of points around places on both sides of the axes, some far from the others.
PointCloud sample_cloud() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> near(-0.4, 0.4);
  std::uniform_int_distribution<int> code(0, 65535);
  PointCloud cloud;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-30.2, 12.7, -3.1), Eigen::Vector3d(410.0, -399.9, 25.6)}) {
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d in_cluster =
          vector_of([&] { return near(random); }).cwiseProduct(Eigen::Vector3d(1, 1, 0.2));
      cloud.positions.emplace_back(kAnchor + place + in_cluster);
      const auto channel = [&] { return static_cast<std::uint16_t>(code(random)); };
      cloud.colors.push_back({channel(), channel(), channel()});
      cloud.intensities.push_back(static_cast<float>(code(random)) / 256.0f);
      cloud.labels.push_back(static_cast<std::uint16_t>(code(random) % 3 * 10));
    }
  }
  return cloud;
}

template <typename Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

// Bytes, not values: -0 and 0 are not the same bits.
bool same_bytes(std::span<const VoxelRecord> a, std::span<const VoxelRecord> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

std::string difference(const VoxelLevel& a, const VoxelLevel& b) {
  if (a.voxel_size() != b.voxel_size()) return "voxel sizes";
  if (!same_voxels(a, b)) return "topology";
  if (!same_bytes(a.records(), b.records())) return "records";
  std::string found;
  for_each_channel([&](const char* name, auto channel) {
    if (found.empty() && !same_bytes(a.channels().*channel, b.channels().*channel)) found = name;
  });
  return found;
}

}  // namespace

BuildOptions anchored(const Eigen::Vector3d& anchor) {
  BuildOptions options;
  options.anchor = anchor;
  return options;
}

bool same_voxels(const VoxelLevel& a, const VoxelLevel& b) { return std::ranges::equal(a.leaves(), b.leaves()); }

VoxelMap fine_map_of(const PointCloud& cloud) {
  BuildOptions options = anchored(Eigen::Vector3d::Zero());
  options.voxel_sizes = {0.1};
  return build_map(cloud, options);
}

VoxelMap map_of_voxels(const std::vector<VoxelIndex>& voxels) {
  PointCloud cloud;
  for (const VoxelIndex& voxel : voxels) cloud.positions.push_back(center_of_voxel(voxel, 0.1));
  return build_map(cloud, anchored(Eigen::Vector3d::Zero()));
}

VoxelLevel coarse_level(const PointCloud& cloud) {
  BuildOptions options = anchored(Eigen::Vector3d::Zero());
  options.voxel_sizes = {1.0};
  return std::move(build_map(cloud, options).levels.front());
}

VoxelMap sample_map() {
  BuildOptions options;
  options.anchor = kAnchor;
  options.epsg = 25832;
  options.epoch = 3;
  VoxelMap map = build_map(sample_cloud(), options);
  map.label_scheme = LabelScheme::kSemanticKitti;
  return map;
}

VoxelMap sample_map_without_attributes() {
  PointCloud cloud = sample_cloud();
  cloud.colors.clear();
  cloud.intensities.clear();
  cloud.labels.clear();
  return build_map(cloud);
}

std::string difference(const VoxelMap& a, const VoxelMap& b) {
  if (!(a.frame == b.frame)) return "frames";
  if (a.has_color != b.has_color) return "has_color";
  if (a.label_scheme != b.label_scheme) return "label schemes";
  if (a.levels.size() != b.levels.size()) return "number of levels";
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    const std::string found = difference(a.levels[i], b.levels[i]);
    if (!found.empty()) return found + " of level " + std::to_string(i);
  }
  return "";
}

}  // namespace vdbmap::test
