// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vdbmap/core/posed_cloud.h"
#include "vdbmap/io/map_from_files.h"
#include "vdbmap/store/city_manifest.h"
#include "vdbmap/store/tile_sums.h"

namespace vdbmap {

/// What the points of sources are like.
struct PointKinds {
  bool has_color = false;
  bool has_intensity = false;
  bool has_labels = false;

  void add(const PointCloud& cloud);
  void add(const PointKinds& other);

  bool operator==(const PointKinds&) const = default;
};

/// What was learnt while the points of sources were added up.
struct CountedPoints {
  std::optional<Eigen::Vector3d> anchor;  ///< that was given, else that of the first source with points
  PointKinds kinds;
  InputNotes notes;
  std::vector<std::uint64_t> num_points;  ///< of each source
};

/// Adds the points of sources to sums, in pieces that together with the sums keep to `memory_bytes`. Throws as
/// read_inputs() does.
CountedPoints count_points(TileSums& sums, const std::vector<MapInput>& inputs, const MapFromFilesOptions& options,
                           std::size_t memory_bytes);

/// The same of clouds at their poses, in the frame of an anchor. Throws std::out_of_range as MapBuilder::add().
PointKinds count_clouds(TileSums& sums, const CloudSource& clouds, const Eigen::Vector3d& anchor, double voxel_size,
                        std::size_t memory_bytes);

/// The anchor that a source decides: anchor_for() all of its points; nothing where it has none. Throws as
/// read_inputs() does.
std::optional<Eigen::Vector3d> anchor_of_source(const MapInput& input, const MapFromFilesOptions& options,
                                                std::size_t memory_bytes);

/// [points] that are read and sorted at once: they take some 250 bytes each, with those read ahead, until they are
/// sums; of these points a third of the memory. The more of them, the fewer times sums are merged.
std::size_t points_at_once(std::size_t memory_bytes);

/// How many bytes of `memory_bytes` sums take: the rest is for points on their way, and tiles when they are finished.
inline std::size_t bytes_of_sums(std::size_t memory_bytes) { return memory_bytes / 2; }

/// What tiles are like that are made of these points alone.
CityLayout layout_of_points(const Eigen::Vector3d& anchor, const PointKinds& kinds, const InputNotes& notes,
                            const BuildOptions& build, float density);

}  // namespace vdbmap
