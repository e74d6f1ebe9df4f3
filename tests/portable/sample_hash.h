// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>

#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/map_merge.h"

/// A number that stands for every bit of some maps. Everything is made here, in each program anew: programs whose code
/// was compiled for different processors must get the same one.
namespace vdbmap::portable {

/// FNV-1a, 64 bits.
class Hash {
 public:
  template <typename Value>
  void add(std::span<const Value> values) {
    for (const std::byte byte : std::as_bytes(values)) {
      state_ = (state_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3;
    }
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325;
};

/// Points of a street's density near UTM coordinates, with all attributes; many lie on borders of voxels before they
/// are turned.
inline PointCloud sample_cloud(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  const auto number = [&](double range) { return range * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = number(20), y = number(20), height = number(0.3);
    const double step = static_cast<double>(random() % 200) / 10.0;
    cloud.positions.emplace_back(i % 3 == 0 ? step : x, y, i % 2 == 0 ? height : 0.1 * step);
    const auto channel = [&] { return static_cast<std::uint16_t>(random()); };
    cloud.colors.push_back({channel(), channel(), channel()});
    cloud.intensities.push_back(static_cast<float>(number(255)));
    cloud.labels.push_back(static_cast<std::uint16_t>(random() % 4));
  }
  return cloud;
}

inline Eigen::Isometry3d sample_pose(double angle) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.36, 0.48, 0.8)));
  pose.translation() = Eigen::Vector3d(548'864.37, 5'804'032.11, 55.3);
  return pose;
}

inline VoxelMap sample_map(unsigned seed) {
  BuildOptions options;
  options.voxel_sizes = {0.1, 0.2, 1};
  options.epoch = 2;
  MapBuilder builder(options);
  builder.add(sample_cloud(seed, 40'000), sample_pose(0.3));
  return builder.finish(sample_cloud(seed + 1, 40'000), sample_pose(-0.2));
}

inline void add(Hash& hash, const VoxelMap& map) {
  hash.add(std::span<const double>(map.frame.anchor.data(), 3));
  for (const VoxelLevel& level : map.levels) {
    for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t) {
      hash.add(std::span<const std::int32_t>(voxel.asPointer(), 3));
    });
    hash.add(level.records());
    for_each_channel([&](const char*, auto channel) { hash.add(std::span(level.channels().*channel)); });
  }
}

inline std::uint64_t sample_hash() {
  Hash hash;
  const VoxelMap a = sample_map(1);
  const VoxelMap b = sample_map(11);
  add(hash, a);
  add(hash, merge_maps(a, b));
  return hash.value();
}

}  // namespace vdbmap::portable
