// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>

#include "vdbmap/core/parallel.h"
#include "vdbmap/render/change_scene.h"
#include "vdbmap/render/decoration.h"
#include "vdbmap/render/overlay.h"
#include "vdbmap/render/plot_area.h"
#include "vdbmap/render/region_outlines.h"
#include "vdbmap/render/voxel_view.h"

namespace vdbmap {
namespace {

constexpr std::array kPathColors = {rgb8(0xe3241f), rgb8(0x18a02a), rgb8(0x1f5fe0), rgb8(0xf08a00), rgb8(0x8a2be2)};
constexpr std::array kPointColors = {rgb8(0xff1fa8), rgb8(0x00d0e0), rgb8(0xfff000)};

// How many of some rays of the camera meet a voxel.
std::size_t num_covered(const VoxelLevel& level, const Camera& camera) {
  constexpr int kSteps = 120;
  const RayCaster caster(level);
  std::array<std::size_t, kSteps> by_row{};
  parallel_for(kSteps, [&](std::size_t row) {
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector2d pixel((i + 0.5) * camera.size().width / kSteps,
                                  (static_cast<double>(row) + 0.5) * camera.size().height / kSteps);
      by_row[row] += caster.is_blocked(camera.ray_through(pixel), {}) ? 1 : 0;
    }
  });
  return std::accumulate(by_row.begin(), by_row.end(), std::size_t{0});
}

// The finest level that is no dust: of sparse points one sees nothing but gaps, and a coarser level tells more.
const VoxelLevel& suitable_level(const VoxelMap& map, const Camera& camera) {
  constexpr std::size_t kMostGaps = 4;  // times as much is covered by the next level
  std::size_t i = 0;
  while (i + 1 < map.levels.size() &&
         kMostGaps * num_covered(map.levels[i], camera) < num_covered(map.levels[i + 1], camera)) {
    ++i;
  }
  return map.levels[i];
}

const VoxelLevel& chosen_level(const VoxelMap& map, double voxel_size, const Camera& camera) {
  if (voxel_size == 0) return suitable_level(map, camera);
  if (const VoxelLevel* level = find_level(map, voxel_size)) return *level;
  throw std::invalid_argument("the map has no level of " + tick_text(voxel_size, 0.001) + " m");
}

std::vector<PathOverlay> paths_of(const RenderOverlays& overlays, const Eigen::Vector3d& anchor) {
  std::vector<PathOverlay> paths;
  for (const NamedTrajectory& trajectory : overlays.trajectories) {
    PathOverlay path{trajectory.name, {{}}, kPathColors[paths.size() % kPathColors.size()]};
    for (const auto& pose : trajectory.poses.map_from_scan) {
      if (pose) {
        path.pieces.back().emplace_back(pose->translation() - anchor);
      } else if (!path.pieces.back().empty()) {
        path.pieces.emplace_back();
      }
    }
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<PointsOverlay> points_of(const RenderOverlays& overlays, const Eigen::Vector3d& anchor) {
  std::vector<PointsOverlay> all;
  for (const NamedPoints& named : overlays.points) {
    PointsOverlay points{named.name, named.points, kPointColors[all.size() % kPointColors.size()]};
    for (Eigen::Vector3d& point : points.points) point -= anchor;
    all.push_back(std::move(points));
  }
  return all;
}

// Places of a camera come in the original system, directions do not depend on it.
std::vector<double> local_numbers(const RenderOptions& options, const Eigen::Vector3d& anchor) {
  std::vector<double> numbers = options.camera;
  const std::size_t num_coordinates = options.view == View::kPlan ? 2 : options.view == View::kPerspective ? 3 : 0;
  for (std::size_t i = 0; i < std::min(num_coordinates, numbers.size()); ++i) {
    numbers[i] -= anchor[static_cast<Eigen::Index>(i)];
  }
  return numbers;
}

// Half of what is seen is nearer.
double median_distance(const VoxelView& view) {
  constexpr std::size_t kStride = 37;
  std::vector<float> distances;
  for (std::size_t i = 0; i < view.distances.size(); i += kStride) {
    if (std::isfinite(view.distances[i])) distances.push_back(view.distances[i]);
  }
  if (distances.empty()) return 1;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

void draw_scale(Image& image, const Camera& camera, const VoxelView& view) {
  if (!camera.is_perspective()) return draw_scale_bar(image, camera.pixel_width(), "");
  const double distance = round_step(0.7 * std::max(1.0, median_distance(view)));
  draw_scale_bar(image, distance * camera.pixel_width(), " at a distance of " + tick_text(distance, distance) + " m");
}

double heading_deg(const Camera& camera) {
  const Eigen::Vector3d right = camera.map_from_camera().linear().col(0);
  return std::atan2(right.x(), -right.y()) * 180 / std::numbers::pi;
}

std::vector<std::pair<std::string, Rgb8>> names_of(const std::vector<PathOverlay>& paths,
                                                   const std::vector<PointsOverlay>& points) {
  std::vector<std::pair<std::string, Rgb8>> names;
  for (const PathOverlay& path : paths) names.emplace_back(path.name, path.color);
  for (const PointsOverlay& cloud : points) names.emplace_back(cloud.name, cloud.color);
  return names;
}

// Paths that lie on each other are all seen: the first is drawn last, and each one after it is a border to those
// before.
void draw_paths(VoxelView& view, const Camera& camera, const std::vector<PathOverlay>& paths, double width) {
  constexpr std::size_t kMaxBorders = 3;  // wider paths would cover the map
  for (std::size_t i = paths.size(); i-- > 0;) {
    draw_path(view, camera, paths[i], static_cast<double>(1 + std::min(i, kMaxBorders)) * width);
  }
}

bool is_in_voxel(const VoxelLevel& level, const Camera& camera) {
  const Eigen::Vector3d eye = camera.map_from_camera().translation();
  const double voxels_per_metre = 1 / level.voxel_size();
  return is_addressable(eye, voxels_per_metre) &&
         VoxelFinder(level).find(voxel_of_point(eye, voxels_per_metre)) != nullptr;
}

// Layers of one scene, of which the first is the finest, with all that is drawn over them.
RenderResult render_layers(std::span<const VoxelLayer> layers, const Eigen::Vector3d& anchor, const Camera& camera,
                           const RenderOptions& options, const RenderOverlays& overlays) {
  const std::vector<PathOverlay> paths = paths_of(overlays, anchor);
  const std::vector<PointsOverlay> points = points_of(overlays, anchor);
  VoxelView view = view_layers(layers, camera);
  if (options.has_decoration && options.view == View::kPlan) draw_metre_grid(view.image, camera, anchor);
  for (const PointsOverlay& cloud : points) draw_points(view, camera, cloud, layers.front().level.voxel_size());
  draw_paths(view, camera, paths, std::max(2.0, letter_size(options.size) / 5.0));
  draw_regions(view, camera, overlays.regions, anchor);
  if (options.has_decoration) {
    draw_scale(view.image, camera, view);
    draw_north_arrow(view.image, heading_deg(camera));
    draw_color_legend(view.image, layers.front().colors.legend(), names_of(paths, points));
  }
  const auto holds_camera = [&](const VoxelLayer& layer) { return is_in_voxel(layer.level, camera); };
  return {std::move(view.image), std::ranges::any_of(layers, holds_camera)};
}

RenderResult render_level(const VoxelMap& map, const VoxelLevel& level, const VoxelColors& colors, const Camera& camera,
                          const RenderOptions& options, const RenderOverlays& overlays) {
  return render_layers(std::array{VoxelLayer{level, colors}}, map.frame.anchor, camera, options, overlays);
}

}  // namespace

Camera camera_of(const VoxelMap& map, const RenderOptions& options, const RenderOverlays& overlays) {
  const std::vector<PathOverlay> paths = paths_of(overlays, map.frame.anchor);
  const std::vector<Eigen::Vector3d> path = paths.empty() ? std::vector<Eigen::Vector3d>{} : paths[0].pieces[0];
  return choose_camera(map.finest(), options.view, options.size, local_numbers(options, map.frame.anchor), path);
}

RenderResult render(const NearAndFar& parts, const Camera& camera, const RenderOptions& options,
                    const RenderOverlays& overlays) {
  const VoxelColors all_colors(parts.all, parts.all.finest(), options.color_by);
  const VoxelColors near_colors(parts.near, parts.near.finest(), all_colors);
  const VoxelColors far_colors(parts.far, parts.far.finest(), all_colors);
  std::vector<VoxelLayer> layers;
  if (parts.near.finest().size() > 0) layers.push_back({parts.near.finest(), near_colors});
  if (parts.far.finest().size() > 0) layers.push_back({parts.far.finest(), far_colors});
  if (layers.empty()) throw std::invalid_argument("the map has no voxels to look at");
  return render_layers(layers, parts.all.frame.anchor, camera, options, overlays);
}

RenderResult render(const VoxelMap& map, const RenderOptions& options, const RenderOverlays& overlays) {
  Image(options.size.width, options.size.height);  // refuses sizes before any work
  if (map.levels.empty()) throw std::invalid_argument("the map has no levels");
  const bool shows_changes = options.color_by.value_or(ColorBy::kChange) == ColorBy::kChange;
  if (overlays.diff && shows_changes) {
    ChangeScene scene = scene_of_changes(map, *overlays.diff);
    const Camera camera = camera_of(map, options, overlays);
    const VoxelColors colors(scene.map, scene.map.finest(), std::move(scene.changes));
    return render_level(scene.map, scene.map.finest(), colors, camera, options, overlays);
  }
  const Camera camera = camera_of(map, options, overlays);
  const VoxelLevel& level = chosen_level(map, options.voxel_size, camera);
  return render_level(map, level, VoxelColors(map, level, options.color_by), camera, options, overlays);
}

}  // namespace vdbmap
