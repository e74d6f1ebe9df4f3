// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/core/range_limits.h"
#include "vdbmap/core/unreachable_points.h"
#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap {

/// A scan and where its points lie.
struct MapInput {
  ScanPlace scan;
  /// Nothing: the points are in map coordinates.
  std::optional<Eigen::Isometry3d> map_from_scan = std::nullopt;
  /// The .label file of its points' classes, which count instead of its own labels.
  std::optional<std::filesystem::path> labels = std::nullopt;
};

/// The pose of an input; identity for points in map coordinates.
Eigen::Isometry3d pose_of(const MapInput& input);

/// How inputs of a map are read.
struct InputOptions {
  std::optional<LabelScheme> label_scheme;   ///< whose numbers labels are, instead of what the files' formats say
  std::vector<std::string> dropped_classes;  ///< points of which are left out, see drop_classes()
  ReadOptions read;                          ///< `is_in_sensor_frame` as the inputs have poses
  std::optional<RangeLimits> range;          ///< of the points of inputs with poses, from their sensor
  bool reads_ahead = true;                   ///< a thread of its own reads what comes next while points are taken
  std::size_t most_points = std::numeric_limits<std::size_t>::max();  ///< of a piece of a large LAS or LAZ file
  std::function<void()> on_scan_done = [] {};                         ///< called after each scan
};

/// A file whose coordinates are not in metres.
struct ForeignUnit {
  std::filesystem::path file;
  double metres_per_unit = 1.0;
};

/// What was noticed in the files.
struct InputNotes {
  std::size_t num_points = 0;              ///< in the map
  std::size_t num_dropped = 0;             ///< points with a coordinate that is not finite
  std::size_t num_out_of_range = 0;        ///< points that the range left out
  std::size_t num_of_dropped_classes = 0;  ///< points of classes that are not wanted
  std::vector<FileFinding> findings;       ///< what else was left out or is doubtful, in the order of the files
  std::optional<int> epsg_of_files;        ///< of the files in map coordinates, where one says so
  std::vector<ForeignUnit> foreign_units;  ///< taken as they are, as if in metres
  LabelScheme label_scheme = LabelScheme::kUnknown;  ///< of the labels; unknown where one file does not say
};

/// Points of an input, number `index`: all of them, or a piece of a large file.
struct InputPoints {
  std::size_t index = 0;
  const PointCloud& cloud;
  bool is_whole = true;
};

/// Takes points and says which of them are not reached.
using TakePoints = std::function<UnreachablePoints(const InputPoints& points)>;

/// What inputs say of their coordinates and labels, on which those of one map must agree.
class InputAgreement {
 public:
  /// Throws IoError where the file, in map coordinates, is in another system than one before.
  void add_epsg(const std::filesystem::path& file, const std::optional<int>& epsg);

  /// Of a file with labels; throws IoError where they are of another scheme than those of one before.
  void add_labels(const std::filesystem::path& file, LabelScheme scheme);

  const std::optional<int>& epsg() const { return epsg_; }

  /// One file that does not say whose numbers its labels are is enough for nobody to know.
  LabelScheme label_scheme() const { return has_unknown_ ? LabelScheme::kUnknown : known_; }

 private:
  std::optional<int> epsg_;
  LabelScheme known_ = LabelScheme::kUnknown;
  bool has_unknown_ = false;
};

/// Reads inputs one after the other; at most two scans, or pieces of files, are in memory at once. Throws IoError
/// naming the scan that cannot be read, of whose points half or more are not reached, or that has another EPSG code or
/// label scheme than one before; and std::invalid_argument for no inputs.
InputNotes read_inputs(const std::vector<MapInput>& inputs, const InputOptions& options, const TakePoints& take);

/// Throws std::invalid_argument where the range left no point of all inputs.
void check_any_point(const InputNotes& notes);

}  // namespace vdbmap
