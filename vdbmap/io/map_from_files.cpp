// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_from_files.h"

#include <future>
#include <stdexcept>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/point_reader.h"

namespace vdbmap {
namespace {

std::future<ReadResult> start_reading(const std::filesystem::path& file, bool reads_ahead) {
  return std::async(reads_ahead ? std::launch::async : std::launch::deferred, [file] { return read_points(file); });
}

void note_epsg(MapFromFiles& result, const std::filesystem::path& file, const std::optional<int>& epsg) {
  if (!epsg) return;
  if (result.epsg_of_files.value_or(*epsg) != *epsg) {
    throw IoError::malformed(file, "is in EPSG:" + std::to_string(*epsg) +
                                       ", files before it are in EPSG:" + std::to_string(*result.epsg_of_files));
  }
  result.epsg_of_files = epsg;
}

void note(MapFromFiles& result, const MapInput& input, const ReadResult& read) {
  result.num_points += read.cloud.size();
  result.num_dropped += read.num_dropped;
  if (read.metres_per_unit != 1.0) result.foreign_units.push_back({input.file, read.metres_per_unit});
  if (!input.map_from_scan) note_epsg(result, input.file, read.epsg);
}

void add(MapBuilder& builder, const MapInput& input, const PointCloud& cloud) {
  try {
    builder.add(cloud, input.map_from_scan.value_or(Eigen::Isometry3d::Identity()));
  } catch (const std::out_of_range& error) {
    throw IoError::malformed(input.file, error.what());
  }
}

}  // namespace

MapFromFiles build_map_from_files(const std::vector<MapInput>& inputs, const MapFromFilesOptions& options) {
  if (inputs.empty()) throw std::invalid_argument("no files to build a map from");
  MapBuilder builder(options.build);
  MapFromFiles result;
  std::future<ReadResult> next = start_reading(inputs.front().file, options.reads_ahead);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const ReadResult read = next.get();
    if (i + 1 < inputs.size()) next = start_reading(inputs[i + 1].file, options.reads_ahead);
    note(result, inputs[i], read);
    add(builder, inputs[i], read.cloud);
    options.on_file_done();
  }
  result.map = builder.finish();
  if (!result.map.frame.epsg) result.map.frame.epsg = result.epsg_of_files;
  return result;
}

}  // namespace vdbmap
