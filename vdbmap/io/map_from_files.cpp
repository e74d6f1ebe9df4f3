// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_from_files.h"

#include <future>
#include <stdexcept>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/label_file.h"

namespace vdbmap {
namespace {

// The reader serves one scan at a time: the one before must have been taken.
std::future<ReadResult> start_reading(ScanReader& reader, const MapInput& input, bool reads_ahead) {
  return std::async(reads_ahead ? std::launch::async : std::launch::deferred, [&reader, &input] {
    ReadResult read = reader.read(input.scan);
    if (input.labels) attach_labels(read, *input.labels);
    return read;
  });
}

void note_epsg(MapFromFiles& result, const std::filesystem::path& file, const std::optional<int>& epsg) {
  if (!epsg) return;
  if (result.epsg_of_files.value_or(*epsg) != *epsg) {
    throw IoError::malformed(file, "is in EPSG:" + std::to_string(*epsg) +
                                       ", files before it are in EPSG:" + std::to_string(*result.epsg_of_files));
  }
  result.epsg_of_files = epsg;
}

// One file that does not say whose numbers its labels are is enough for nobody to know.
void note_scheme(MapFromFiles& result, const std::filesystem::path& file, LabelScheme scheme) {
  const LabelScheme before = result.scheme_of_files.value_or(scheme);
  const bool are_known = scheme != LabelScheme::kUnknown && before != LabelScheme::kUnknown;
  if (are_known && scheme != before) {
    throw IoError::malformed(
        file, "has labels of " + std::string(text_of(scheme)) + ", files before it of " + std::string(text_of(before)));
  }
  result.scheme_of_files = are_known ? scheme : LabelScheme::kUnknown;
}

void note(MapFromFiles& result, const MapInput& input, const ReadResult& read) {
  result.num_points += read.cloud.size();
  result.num_dropped += read.dropped.size();
  if (read.metres_per_unit != 1.0) result.foreign_units.push_back({input.scan.file, read.metres_per_unit});
  if (!read.cloud.labels.empty()) note_scheme(result, input.scan.file, read.label_scheme);
  if (!input.map_from_scan) note_epsg(result, input.scan.file, read.epsg);
}

Eigen::Isometry3d pose_of(const MapInput& input) { return input.map_from_scan.value_or(Eigen::Isometry3d::Identity()); }

[[noreturn]] void throw_unreachable(const MapInput& input, const std::out_of_range& error) {
  throw IoError::malformed(input.scan.name(), error.what());
}

void add(MapBuilder& builder, const MapInput& input, const PointCloud& cloud) {
  try {
    builder.add(cloud, pose_of(input));
  } catch (const std::out_of_range& error) {
    throw_unreachable(input, error);
  }
}

VoxelMap finish(MapBuilder& builder, const MapInput& last_input, const PointCloud& last_cloud) {
  try {
    return builder.finish(last_cloud, pose_of(last_input));
  } catch (const std::out_of_range& error) {
    throw_unreachable(last_input, error);
  }
}

}  // namespace

MapFromFiles build_map_from_files(const std::vector<MapInput>& inputs, const MapFromFilesOptions& options) {
  if (inputs.empty()) throw std::invalid_argument("no scans to build a map from");
  MapBuilder builder(options.build);
  MapFromFiles result;
  ScanReader reader;
  std::future<ReadResult> next = start_reading(reader, inputs.front(), options.reads_ahead);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    ReadResult read = next.get();
    const bool is_last = i + 1 == inputs.size();
    if (!is_last) next = start_reading(reader, inputs[i + 1], options.reads_ahead);
    if (options.label_scheme) read.label_scheme = *options.label_scheme;
    note(result, inputs[i], read);
    if (is_last) {
      result.map = finish(builder, inputs[i], read.cloud);
    } else {
      add(builder, inputs[i], read.cloud);
    }
    options.on_scan_done();
  }
  result.map.label_scheme = result.scheme_of_files.value_or(LabelScheme::kUnknown);
  if (!result.map.frame.epsg) result.map.frame.epsg = result.epsg_of_files;
  return result;
}

}  // namespace vdbmap
