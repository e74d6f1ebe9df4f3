// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_from_files.h"

namespace vdbmap {

MapFromFiles build_map_from_files(const std::vector<MapInput>& inputs, const MapFromFilesOptions& options) {
  MapBuilder builder(options.build);
  MapFromFiles result;
  result.notes = read_inputs(inputs, options.inputs, [&](const InputPoints& points) {
    const Eigen::Isometry3d map_from_scan = pose_of(inputs[points.index]);
    if (points.index + 1 == inputs.size() && points.is_whole) {
      result.map = builder.finish(points.cloud, map_from_scan);
    } else {
      builder.add(points.cloud, map_from_scan);
    }
    return builder.unreachable();
  });
  check_any_point(result.notes);
  if (result.map.levels.empty()) result.map = builder.finish();
  result.map.label_scheme = result.notes.label_scheme;
  if (!result.map.frame.epsg) result.map.frame.epsg = result.notes.epsg_of_files;
  return result;
}

}  // namespace vdbmap
