// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_reader.h"

#include <cmath>
#include <cstdint>

#include "vdbmap/core/error.h"
#include "vdbmap/core/voxel_sums.h"
#include "vdbmap/io/kitti/kitti_bin.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/pcd/pcd.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/points/point_format.h"
#include "vdbmap/io/table/xyz.h"
#include "vdbmap/io/velodyne/vlp16_pcap.h"

namespace vdbmap {

namespace {

ReadResult read_any(const std::filesystem::path& path, const ReadOptions& options) {
  switch (detect_point_format(path)) {
    case PointFormat::kPly:
      return read_ply(path);
    case PointFormat::kPcd:
      return read_pcd(path);
    case PointFormat::kLas:
      return read_las(path);
    case PointFormat::kKittiBin:
      return read_kitti_bin(path, options.bin_columns, options.bin_type);
    case PointFormat::kXyz:
      return read_xyz(path, options.columns);
    case PointFormat::kVlp16Pcap:
      return read_vlp16_pcap(path, options);
  }
  throw IoError::malformed(path, "not a point file");
}

void note_large_intensities(ReadResult& read) {
  std::uint32_t count = 0;  // as wide as the numbers, so that eight are compared at a time
  for (const float intensity : read.cloud.intensities) {
    count += std::abs(intensity) > static_cast<float>(kLargestIntensity) ? 1U : 0U;
  }
  if (count > 0) read.findings.push_back({"intensities beyond 2^39, which a map leaves out", count});
}

}  // namespace

void refuse_damage(const std::filesystem::path& path, const std::vector<ReadFinding>& findings) {
  for (const ReadFinding& finding : findings) {
    if (finding.is_damage) throw IoError::malformed(path, finding.text());
  }
}

ReadResult read_points(const std::filesystem::path& path, const ReadOptions& options) {
  ReadResult read = read_any(path, options);
  drop_points_at_origin(path, read, options.is_in_sensor_frame);
  note_large_intensities(read);
  if (options.strict) refuse_damage(path, read.findings);
  return read;
}

}  // namespace vdbmap
