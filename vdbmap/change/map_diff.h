// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/visibility.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap {

/// What became of a voxel between two maps. The numbers are those of files and pages.
enum class Change : std::uint8_t {
  kUnchanged = 0,
  kAppeared = 1,    ///< occupied in the later map, seen empty in the earlier one
  kVanished = 2,    ///< occupied in the earlier map, seen empty in the later one
  kChanged = 3,     ///< what both saw there differs significantly
  kUnobserved = 4,  ///< occupied in one map, never seen by the other
};

/// "unchanged", "appeared", "vanished", "changed", "unobserved".
const char* name_of(Change change);

/// When two maps differ.
struct DiffOptions {
  double pose_sigma = 0.018;    ///< [m] standard deviation of one map's place against the other's, along any direction
  double range_sigma = 0.01;    ///< [m] of what ranges of a whole surface have in common: calibration, material, angle
  double significance = 0.001;  ///< how often a test may fail by chance where nothing changed, 0 to 0.5
  bool takes_unseen_as_empty = false;  ///< for maps without rays: what a map does not hold, it saw empty
  /// What moves a point of the later map, in the original system, to its place in the earlier one.
  Eigen::Isometry3d earlier_from_later = Eigen::Isometry3d::Identity();

  /// Throws std::invalid_argument naming the value and what is allowed.
  void check() const;
};

/// A map and what its rays saw; nullptr where nothing is known of them.
struct SeenMap {
  const VoxelMap& map;
  const Visibility* visibility = nullptr;
};

/// Numbers of voxels: those of the later map, and those of the earlier one where the later one has none.
struct ChangeCounts {
  std::uint64_t appeared = 0;
  std::uint64_t vanished = 0;
  std::uint64_t changed = 0;
  std::uint64_t unchanged = 0;
  std::uint64_t unobserved = 0;

  void add(const ChangeCounts& other);
  bool operator==(const ChangeCounts&) const = default;
};

/// Voxels of one kind of change, as the map has them that they are of, in the frame of the diff.
struct ChangedVoxels {
  VoxelLevel level;                ///< with labels where the map has them
  std::vector<float> confidences;  ///< one a record, 0 to 1; see map_diff()
};

/// What differs between two maps, in the frame of the later one. A voxel is of one kind at most: where one map was
/// moved and voxels of both fall into one, the one that appeared or else changed is kept, and the others are counted
/// only.
struct MapDiff {
  MapFrame frame;
  LabelScheme label_scheme = LabelScheme::kUnknown;
  ChangeCounts counts;
  ChangedVoxels appeared;  ///< of the later map
  ChangedVoxels vanished;  ///< of the earlier map
  ChangedVoxels changed;   ///< of the later map; of the earlier one where the later one has no voxel
  VoxelTree unobserved{{}};

  double voxel_size() const { return appeared.level.voxel_size(); }
};

/// Compares the finest levels of two maps, leaf by leaf in place. The same for any number of threads.
///
/// A voxel is unchanged where what the other map has nearby explains it. With 3 x 3 x 3 voxels around it that lie in a
/// plane in both maps, and parallel, the planes are compared: their distance d along the normal has the variance
/// t_a^2 / n_a + t_b^2 / n_b + pose_sigma^2 + range_sigma^2, t the thickness of the surfaces and n their points; it is
/// significant where |d| exceeds the quantile of the normal distribution. So noise averages out, what a survey's pose
/// and calibration do to a whole wall does not, and where voxels end does not matter. A voxel on a plane is compared
/// with the plane's thickness; one that both maps have but not on planes, with the distribution of the other's points
/// there (Mahalanobis' distance, chi squared with 3 degrees of freedom); at edges the place of the edge is compared
/// (distance_of_edges()).
///
/// What is not explained has changed where the other map has a voxel there too, or a parallel plane. Where the other
/// map saw the place empty it appeared or vanished, if that map saw something of both sides of it: rays may graze a
/// surface without one of them ending near by. Porous things (leaves, fences), through which rays may pass, explain
/// what is beside them; voxels that their own map's rays passed nine times of ten, and voxels with
/// less than two others of any change around them, are no change.
///
/// Confidence: of a changed voxel the probability that such surveys of the same two days again differ significantly; of
/// others the share of the 3 x 3 x 3 voxels around them of which the other map knows whether they are empty.
///
/// Throws std::invalid_argument for bad options, maps without levels, other voxel sizes or EPSG codes, and visibility
/// that is not of its map.
MapDiff map_diff(const SeenMap& earlier, const SeenMap& later, const DiffOptions& options = {});

/// The same for the voxels in a box of the later map's leaves alone [voxels of the later map's frame]; those around it
/// are looked at as neighbours only.
MapDiff map_diff_in(const openvdb::CoordBBox& box, const SeenMap& earlier, const SeenMap& later,
                    const DiffOptions& options = {});

/// One diff of several of different places, which have no voxel in common and one frame. Throws std::invalid_argument
/// without any.
MapDiff join_diffs(const std::vector<MapDiff>& diffs);

}  // namespace vdbmap
