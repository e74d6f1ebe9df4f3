// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/core/label_scheme.h"
#include "vdbmap/core/point_cloud.h"
#include "vdbmap/io/file/read_finding.h"
#include "vdbmap/io/file/scalar_type.h"
#include "vdbmap/io/points/sensor_choice.h"

namespace vdbmap {

/// How point files are read.
struct ReadOptions {
  bool strict = false;              ///< damage is an error, not a finding
  bool is_in_sensor_frame = false;  ///< then points at the origin are no measurements: see drop_points_at_origin()
  std::optional<SensorChoice> sensor = {};  ///< of a packet capture; nothing: the first
  std::vector<std::string> columns = {};  ///< of text tables, as check_columns() knows them; empty: what the file says
  std::vector<std::string> bin_columns = {};  ///< of .bin files; empty: what the numbers say
  std::optional<ScalarType> bin_type = {};    ///< of .bin files: float32 or float64; nothing: what the numbers say
};

/// What a point file held.
struct ReadResult {
  PointCloud cloud;
  std::vector<std::size_t> dropped;                  ///< places in the file of all points that were left out, rising
  std::size_t num_non_finite = 0;                    ///< of these: with a coordinate that is not finite
  std::vector<ReadFinding> findings;                 ///< what else was left out or is doubtful, in the order it was met
  LabelScheme label_scheme = LabelScheme::kUnknown;  ///< whose numbers the labels are, where the format says so
  std::optional<int> epsg;                           ///< of the coordinates, where the file says so
  double metres_per_unit = 1.0;  ///< length of the file's unit, where the file says so (a LAS file in feet: 0.3048)
};

/// Reads a PLY, PCD, LAS, LAZ, KITTI .bin, XYZ/CSV or VLP-16 .pcap file; the content decides, then the extension.
/// What can be read in a damaged file is read, and the findings say what was left out. A file that holds no point is an
/// error. Throws IoError with the place and the reason; never allocates more than the file's own size can account for.
ReadResult read_points(const std::filesystem::path& path, const ReadOptions& options = {});

/// What strict reading does with damage: throws IoError with the first finding that is one.
void refuse_damage(const std::filesystem::path& path, const std::vector<ReadFinding>& findings);

/// Point files, and what in their folders was left out.
struct PointFiles {
  std::vector<std::filesystem::path> files;
  std::vector<FileFinding> findings;  ///< each of a folder
};

/// The point files that `inputs` name, in order: a file stands for itself, a folder for the point files directly in it,
/// in the order of comes_before(). Text in a folder may be anything: what holds poses, positions of the vehicle, times
/// and the like is no scan, nor is .csv beside scans of other formats and names; .txt files are scans only where the
/// folder holds no others. Throws IoError for a missing input or a folder without any.
PointFiles find_point_files(const std::vector<std::filesystem::path>& inputs);

/// The files alone.
std::vector<std::filesystem::path> list_point_files(const std::vector<std::filesystem::path>& inputs);

}  // namespace vdbmap
