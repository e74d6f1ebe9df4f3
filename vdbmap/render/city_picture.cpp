// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/city_picture.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/city_window.h"

namespace vdbmap {
namespace {

Eigen::AlignedBox3d local_box(const CityTile& tile, const CityLayout& layout) {
  return {tile.extent.min - layout.frame.anchor, tile.extent.max - layout.frame.anchor};
}

bool knows_camera(const RenderOptions& options) {
  return options.view == View::kPerspective && !options.camera.empty();
}

// All levels but the finest, of what the camera may see where it is known, else of all: to choose one.
VoxelMap load_coarser(City& city, const RenderOptions& options, const RenderOverlays& overlays) {
  TileChoice is_wanted = [](const CityTile&) { return true; };
  const CityLayout layout = city.manifest.layout;
  if (knows_camera(options)) {
    const Camera camera = camera_of(empty_map(layout.frame, layout.voxel_sizes), options, overlays);
    is_wanted = [=](const CityTile& tile) { return camera.may_see(local_box(tile, layout)); };
  }
  VoxelMap map = load_coarser_window(city, is_wanted);
  map.levels.erase(map.levels.begin());
  return map;
}

// Width [m] of a pixel on what the box holds nearest to the camera.
double pixel_on(const Eigen::AlignedBox3d& box, const Camera& camera) {
  const double distance = camera.is_perspective() ? box.exteriorDistance(camera.map_from_camera().translation()) : 1;
  return distance * camera.pixel_width();
}

// Tiles that are drawn by their finest level, nearest first as long as there is room.
std::set<TileId> tiles_in_detail(const CityManifest& manifest, const Camera& camera, std::uint64_t max_voxels) {
  std::vector<std::pair<double, const CityTile*>> near;
  for (const CityTile& tile : manifest.tiles) {
    const Eigen::AlignedBox3d box = local_box(tile, manifest.layout);
    const double pixel = pixel_on(box, camera);
    if (pixel < manifest.layout.voxel_sizes.front() && camera.may_see(box)) near.emplace_back(pixel, &tile);
  }
  std::ranges::stable_sort(near, {}, &std::pair<double, const CityTile*>::first);
  std::set<TileId> tiles;
  std::uint64_t num_voxels = 0;
  for (const auto& [pixel, tile] : near) {
    num_voxels += tile->num_voxels.front();
    if (num_voxels > max_voxels) break;
    tiles.insert(tile->id);
  }
  return tiles;
}

VoxelMap without_tiles(const VoxelMap& map, const std::set<TileId>& tiles) {
  std::vector<VoxelMap> parts;
  for_each_tile(map, [&](const TileId& id, const VoxelMap& part) {
    if (!tiles.contains(id)) parts.push_back(part);
  });
  if (!parts.empty()) return splice(parts);
  VoxelMap none = map;
  for (VoxelLevel& level : none.levels) level = VoxelLevel(level.voxel_size(), {}, {});
  return none;
}

}  // namespace

RenderResult render_city(City& city, const RenderOptions& options, const RenderOverlays& overlays,
                         std::uint64_t max_voxels) {
  const std::vector<double>& sizes = city.manifest.layout.voxel_sizes;
  const bool is_small = city.manifest.tiles.empty() || num_voxels(city.manifest).front() <= max_voxels;
  const bool wants_finest = std::abs(options.voxel_size - sizes.front()) < 1e-9;
  if (is_small || sizes.size() < 2 || wants_finest || overlays.diff) return render(load_city(city), options, overlays);

  const CityManifest before = city.manifest;
  const VoxelMap all = load_coarser(city, options, overlays);
  if (options.voxel_size != 0) return render(all, options, overlays);
  const Camera camera = camera_of(all, options, overlays);
  const std::set<TileId> in_detail = tiles_in_detail(city.manifest, camera, max_voxels);
  const VoxelMap near = load_window(city, [&](const CityTile& tile) { return in_detail.contains(tile.id); });
  if (city.manifest != before) throw IoError::malformed(city.folder, "was changed while it was read");
  const VoxelMap far = without_tiles(all, in_detail);
  return render({near, far, all}, camera, options, overlays);
}

}  // namespace vdbmap
