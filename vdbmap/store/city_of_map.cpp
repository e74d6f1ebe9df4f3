// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_of_map.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/city_writer.h"

namespace vdbmap {
namespace {

std::int32_t latest_epoch(const VoxelMap& map) {
  const std::vector<std::int32_t>& epochs = map.finest().channels().last_epochs;
  return epochs.empty() ? 0 : std::max(0, *std::ranges::max_element(epochs));
}

}  // namespace

CityManifest save_city(const std::filesystem::path& folder, const VoxelMap& map, const SaveOptions& options,
                       const std::vector<MapSource>& sources) {
  CityWriter writer(folder);
  if (writer.current()) throw IoError::malformed(folder, "holds a city already");
  CityManifest manifest{latest_epoch(map), layout_of(map, options.density), {}, sources};
  for_each_tile(map, [&](const TileId& id, const VoxelMap& tile) {
    manifest.tiles.push_back(writer.save_tile(id, tile, options.density));
  });
  writer.publish(manifest, std::numeric_limits<std::size_t>::max());
  return manifest;
}

}  // namespace vdbmap
