// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/map_from_files.h"

namespace vdbmap {

MapFromFiles build_map_from_files(const std::vector<MapInput>& inputs, const MapFromFilesOptions& options) {
  MapBuilder builder(options.build);
  MapFromFiles result;
  result.notes = read_inputs(inputs, options.inputs, [&](std::size_t index, const PointCloud& cloud) {
    if (index + 1 < inputs.size()) {
      builder.add(cloud, pose_of(inputs[index]));
    } else {
      result.map = builder.finish(cloud, pose_of(inputs[index]));
    }
    return builder.unreachable();
  });
  result.map.label_scheme = result.notes.label_scheme;
  if (!result.map.frame.epsg) result.map.frame.epsg = result.notes.epsg_of_files;
  return result;
}

}  // namespace vdbmap
