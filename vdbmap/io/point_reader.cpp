// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/point_reader.h"

#include "vdbmap/core/error.h"
#include "vdbmap/io/kitti_bin.h"
#include "vdbmap/io/las.h"
#include "vdbmap/io/pcd.h"
#include "vdbmap/io/ply.h"
#include "vdbmap/io/point_cloud_filter.h"
#include "vdbmap/io/point_format.h"
#include "vdbmap/io/vlp16_pcap.h"
#include "vdbmap/io/xyz.h"

namespace vdbmap {

namespace {

ReadResult read_any(const std::filesystem::path& path, [[maybe_unused]] const ReadOptions& options) {
  switch (detect_point_format(path)) {
    case PointFormat::kPly:
      return read_ply(path);
    case PointFormat::kPcd:
      return read_pcd(path);
    case PointFormat::kLas:
      return read_las(path);
    case PointFormat::kKittiBin:
      return read_kitti_bin(path);
    case PointFormat::kXyz:
      return read_xyz(path);
    case PointFormat::kVlp16Pcap:
      return read_vlp16_pcap(path);
  }
  throw IoError::malformed(path, "not a point file");
}

// A sensor measures no point where it is itself: that is how many drivers write a beam without a return. Elsewhere one
// such point may be meant, as the corner of a model.
void drop_points_at_origin(ReadResult& read, const std::filesystem::path& path, bool is_in_sensor_frame) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < read.cloud.size(); ++i) {
    if (read.cloud.positions[i].isZero(0)) places.push_back(i);
  }
  if (places.size() < (is_in_sensor_frame ? 1U : 2U)) return;
  drop_points(read, places, {"points at the sensor's origin, beams without a return, left out", places.size()});
  if (read.cloud.empty()) throw IoError::malformed(path, "all of its points lie at the sensor's origin");
}

}  // namespace

void refuse_damage(const std::filesystem::path& path, const std::vector<ReadFinding>& findings) {
  for (const ReadFinding& finding : findings) {
    if (finding.is_damage) throw IoError::malformed(path, finding.text());
  }
}

ReadResult read_points(const std::filesystem::path& path, const ReadOptions& options) {
  ReadResult read = read_any(path, options);
  drop_points_at_origin(read, path, options.is_in_sensor_frame);
  if (options.strict) refuse_damage(path, read.findings);
  return read;
}

}  // namespace vdbmap
