// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/voxel_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "vdbmap/core/parallel.h"
#include "vdbmap/render/face_table.h"
#include "vdbmap/render/ray_beams.h"
#include "vdbmap/render/shading.h"

namespace vdbmap {
namespace {

constexpr std::size_t kRowsAtOnce = 8;
constexpr float kFar = std::numeric_limits<float>::infinity();

constexpr double kClearAir = 300;  // [m] haze is never thicker than that

constexpr int kTileSize = 8;  // [pixels] rays of a tile share a beam

// Further samples of a pixel at an edge; with the middle four, no two in a row or column.
constexpr std::array<std::array<double, 2>, 3> kFurther = {{{0.125, 0.625}, {0.625, 0.125}, {0.875, 0.875}}};

/// Samples of a pixel at an edge, beside the one at its middle.
struct EdgePixel {
  int x;
  std::array<FaceCode, kFurther.size()> faces;
};

/// What every pixel sees.
struct PixelSights {
  explicit PixelSights(const ImageSize& size)
      : width(size.width),
        height(size.height),
        faces(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        planes(faces.size()),
        distances(faces.size()),
        edges(static_cast<std::size_t>(height)) {}

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }

  int width;
  int height;
  std::vector<FaceCode> faces;                ///< at the middle of each pixel
  std::vector<std::int32_t> planes;           ///< in which these faces lie: equal for faces side by side
  std::vector<float> distances;               ///< [m]
  std::vector<std::vector<EdgePixel>> edges;  ///< by row, from the left
};

std::int32_t plane_of(const RayHit& hit) { return 6 * hit.voxel[hit.face / 2] + hit.face; }

/// Records of all layers are numbered one after the other.
std::vector<std::size_t> first_records(std::span<const VoxelLayer> layers) {
  std::vector<std::size_t> first = {0};
  for (const VoxelLayer& layer : layers) first.push_back(first.back() + layer.level.size());
  return first;
}

/// Follows rays through all layers.
class LayerCaster {
 public:
  LayerCaster(std::span<const VoxelLayer> layers, const Camera& camera) : first_records_(first_records(layers)) {
    for (const VoxelLayer& layer : layers) {
      casters_.emplace_back(layer.level);
      beams_.push_back(std::make_unique<RayBeams>(layer.level, camera, kTileSize));
    }
  }

  /// With the number of the record among those of all layers.
  std::optional<RayHit> first_hit(const Ray& ray, double begin) const {
    std::optional<RayHit> first;
    for (std::size_t i = 0; i < casters_.size(); ++i) {
      std::optional<RayHit> hit = casters_[i].first_hit(ray, {begin});
      if (!hit || (first && first->distance <= hit->distance)) continue;
      hit->record += first_records_[i];
      first = hit;
    }
    return first;
  }

  double free_distance(int left, int top) const {
    double distance = beams_.front()->free_distance(left, top);
    for (const auto& beams : beams_) distance = std::min(distance, beams->free_distance(left, top));
    return distance;
  }

 private:
  std::vector<std::size_t> first_records_;
  std::vector<RayCaster> casters_;
  std::vector<std::unique_ptr<RayBeams>> beams_;
};

/// Looks along the rays of a camera and marks the faces it sees.
class Observer {
 public:
  Observer(std::span<const VoxelLayer> layers, const Camera& camera, FaceTable& table)
      : caster_(layers, camera), camera_(camera), table_(table) {
    for (const VoxelLayer& layer : layers) {
      voxel_sizes_.push_back(layer.level.voxel_size());
      largest_voxel_ = std::max(largest_voxel_, layer.level.voxel_size());
    }
    first_records_ = first_records(layers);
  }

  // The rows of tiles from `top` on.
  void look_at_middles(PixelSights& sight, int top) const {
    for (int left = 0; left < sight.width; left += kTileSize) {
      const double begin = caster_.free_distance(left, top);
      for (int y = top; y < std::min(top + kTileSize, sight.height); ++y) {
        for (int x = left; x < std::min(left + kTileSize, sight.width); ++x) look_at_middle(sight, x, y, begin);
      }
    }
  }

  void look_at_edges(PixelSights& sight, int y) const {
    for (int x = 0; x < sight.width; ++x) {
      if (!is_at_edge(sight, x, y)) continue;
      EdgePixel pixel{x, {}};
      const double begin = nearest_around(sight, x, y);
      for (std::size_t i = 0; i < kFurther.size(); ++i) {
        const auto hit = caster_.first_hit(camera_.ray_through({x + kFurther[i][0], y + kFurther[i][1]}), begin);
        pixel.faces[i] = hit ? face_code(*hit) : kNoFace;
        if (hit) table_.mark(pixel.faces[i]);
      }
      sight.edges[static_cast<std::size_t>(y)].push_back(pixel);
    }
  }

 private:
  void look_at_middle(PixelSights& sight, int x, int y, double begin) const {
    const std::size_t i = sight.index(x, y);
    const auto hit = caster_.first_hit(camera_.ray_through({x + 0.5, y + 0.5}), begin);
    sight.faces[i] = hit ? face_code(*hit) : kNoFace;
    sight.planes[i] = hit ? plane_of(*hit) : 0;
    sight.distances[i] = hit ? static_cast<float>(hit->distance) : kFar;
    if (hit) table_.mark(sight.faces[i]);
  }

  // Neighbours in one plane of voxels of a few pixels differ too little to be worth further rays.
  bool is_edge(const PixelSights& sight, std::size_t a, std::size_t b) const {
    if (sight.faces[a] == sight.faces[b]) return false;
    if (sight.faces[a] == kNoFace || sight.faces[b] == kNoFace || sight.planes[a] != sight.planes[b]) return true;
    const double pixel = camera_.is_perspective() ? sight.distances[a] * camera_.pixel_width() : camera_.pixel_width();
    const double voxel_size = voxel_size_of(sight.faces[a]);
    return voxel_size < pixel || voxel_size > 4 * pixel;
  }

  double voxel_size_of(FaceCode face) const {
    std::size_t layer = 0;
    while (face / 6 >= first_records_[layer + 1]) ++layer;
    return voxel_sizes_[layer];
  }

  bool is_at_edge(const PixelSights& sight, int x, int y) const {
    const std::size_t here = sight.index(x, y);
    return (x > 0 && is_edge(sight, here, sight.index(x - 1, y))) ||
           (x + 1 < sight.width && is_edge(sight, here, sight.index(x + 1, y))) ||
           (y > 0 && is_edge(sight, here, sight.index(x, y - 1))) ||
           (y + 1 < sight.height && is_edge(sight, here, sight.index(x, y + 1)));
  }

  // Further rays of a pixel begin a little before what its neighbours see, which saves most of their way.
  double nearest_around(const PixelSights& sight, int x, int y) const {
    float nearest = kFar;
    for (int j = std::max(0, y - 1); j <= std::min(sight.height - 1, y + 1); ++j) {
      for (int i = std::max(0, x - 1); i <= std::min(sight.width - 1, x + 1); ++i) {
        nearest = std::min(nearest, sight.distances[sight.index(i, j)]);
      }
    }
    return std::max(0.0, 0.98 * static_cast<double>(nearest) - 3 * largest_voxel_);
  }

  LayerCaster caster_;
  const Camera& camera_;
  FaceTable& table_;
  std::vector<double> voxel_sizes_;  // of the layers
  std::vector<std::size_t> first_records_;
  double largest_voxel_ = 0;
};

template <typename Body>
void for_each_row(int height, const Body& body) {
  parallel_for(
      static_cast<std::size_t>(height), [&](std::size_t y) { body(static_cast<int>(y)); }, kRowsAtOnce);
}

PixelSights look(std::span<const VoxelLayer> layers, const Camera& camera, FaceTable& table) {
  PixelSights sight(camera.size());
  const Observer observer(layers, camera, table);
  const int num_tile_rows = (sight.height + kTileSize - 1) / kTileSize;
  parallel_for(static_cast<std::size_t>(num_tile_rows),
               [&](std::size_t row) { observer.look_at_middles(sight, static_cast<int>(row) * kTileSize); });
  for_each_row(sight.height, [&](int y) { observer.look_at_edges(sight, y); });
  return sight;
}

Eigen::Vector3d direction_to_viewer(const Camera& camera, const Eigen::Vector3d& point) {
  if (!camera.is_perspective()) return -camera.map_from_camera().linear().col(2);
  return (camera.map_from_camera().translation() - point).normalized();
}

/// Gives the faces that are seen of a voxel their colour and light.
class FaceLighter {
 public:
  /// The first record of the layer has a number among those of all layers.
  FaceLighter(const VoxelLayer& layer, std::size_t first_record, const Camera& camera, const FaceTable& table)
      : level_(layer.level),
        colors_(layer.colors),
        first_record_(first_record),
        camera_(camera),
        table_(table),
        caster_(layer.level),
        lighting_(Lighting::for_camera(camera)) {}

  void light(const VoxelIndex& voxel, std::size_t record, std::vector<LinearColor>& lit) const {
    const unsigned seen = table_.seen(first_record_ + record);
    if (seen == 0) return;
    const LinearColor color = colors_.color_of(voxel, record);
    const Eigen::Vector3d center = center_of_voxel(voxel, level_.voxel_size());
    const Eigen::Vector3d to_viewer = direction_to_viewer(camera_, center);
    std::array<Eigen::Vector3d, 6> normals;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for_each_bit(seen, [&](VoxelFace face) {
      normals[face] = shading_normal(level_.records()[record], face, to_viewer);
      sum += normals[face];
    });
    // The surroundings are looked at once a voxel, in the mean direction of its faces.
    const LightOnVoxel light =
        light_on_voxel(caster_, center, level_.voxel_size(), sum.normalized(), lighting_, rays_for(voxel, center));
    for_each_bit(seen, [&](VoxelFace face) {
      const LinearColor falls_in = light_on_face(light, normals[face], lighting_);
      lit[table_.number(static_cast<FaceCode>(6 * (first_record_ + record) + face))] = color.cwiseProduct(falls_in);
    });
  }

 private:
  SkyRays rays_for(const VoxelIndex& voxel, const Eigen::Vector3d& center) const {
    constexpr double kSmall = 1.5;  // [pixels]
    const double distance = (center - camera_.map_from_camera().translation()).norm();
    const double pixel = camera_.is_perspective() ? distance * camera_.pixel_width() : camera_.pixel_width();
    if (level_.voxel_size() > kSmall * pixel) return SkyRays::kAll;
    return ((voxel.x() ^ voxel.y() ^ voxel.z()) & 1) == 0 ? SkyRays::kEvenHalf : SkyRays::kOddHalf;
  }

  template <typename Body>
  static void for_each_bit(unsigned bits, const Body& body) {
    for (; bits != 0; bits &= bits - 1) body(static_cast<VoxelFace>(std::countr_zero(bits)));
  }

  const VoxelLevel& level_;
  const VoxelColors& colors_;
  std::size_t first_record_;
  const Camera& camera_;
  const FaceTable& table_;
  RayCaster caster_;
  Lighting lighting_;
};

// Colour and light of every face that is seen, by its number.
std::vector<LinearColor> light_faces(std::span<const VoxelLayer> layers, const Camera& camera, FaceTable& table) {
  std::vector<LinearColor> lit(table.count());
  std::size_t first_record = 0;
  for (const VoxelLayer& layer : layers) {
    const FaceLighter lighter(layer, first_record, camera, table);
    parallel_for_each_voxel(layer.level,
                            [&](const VoxelIndex& voxel, std::size_t record) { lighter.light(voxel, record, lit); });
    first_record += layer.level.size();
  }
  return lit;
}

/// Tells near from far: at the far end of what is seen at most a fifth of the colour is lost.
struct Haze {
  double begin = 0;           ///< [m]
  double clear_distance = 1;  ///< [m] after which 1/e is left

  float share(double distance) const {
    return static_cast<float>(1 - std::exp(-std::max(0.0, distance - begin) / clear_distance));
  }
};

/// Turns what is seen into pixels.
class Painter {
 public:
  Painter(const PixelSights& sight, const FaceTable& table, const std::vector<LinearColor>& lit, const Camera& camera,
          const Haze& haze)
      : sight_(sight), table_(table), lit_(lit), camera_(camera), haze_(haze) {}

  void paint_row(Image& image, int y) const {
    const std::vector<EdgePixel>& edges = sight_.edges[static_cast<std::size_t>(y)];
    auto edge = edges.begin();
    for (int x = 0; x < sight_.width; ++x) {
      LinearColor color = color_of(sight_.faces[sight_.index(x, y)], x, y);
      if (edge != edges.end() && edge->x == x) {
        for (const FaceCode face : edge->faces) color += color_of(face, x, y);
        color /= 1 + static_cast<float>(kFurther.size());
        ++edge;
      }
      image.at(x, y) = pixel_of(color);
    }
  }

 private:
  LinearColor color_of(FaceCode face, int x, int y) const {
    if (face == kNoFace) return background(camera_, camera_.ray_through({x + 0.5, y + 0.5}).direction);
    const LinearColor& color = lit_[table_.number(face)];
    const float distance = sight_.distances[sight_.index(x, y)];
    if (!camera_.is_perspective() || distance == kFar) return color;
    return color + (haze_color() - color) * haze_.share(distance);
  }

  const PixelSights& sight_;
  const FaceTable& table_;
  const std::vector<LinearColor>& lit_;
  const Camera& camera_;
  Haze haze_;
};

Haze haze_of(const PixelSights& sight) {
  float nearest = kFar;
  float farthest = 0;
  for (const float distance : sight.distances) {
    if (distance == kFar) continue;
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  }
  if (nearest == kFar) return {};
  return {nearest, std::max(kClearAir, 4 * (static_cast<double>(farthest) - nearest))};
}

}  // namespace

VoxelView view_voxels(const VoxelLevel& level, const VoxelColors& colors, const Camera& camera) {
  return view_layers(std::array{VoxelLayer{level, colors}}, camera);
}

VoxelView view_layers(std::span<const VoxelLayer> layers, const Camera& camera) {
  Image image(camera.size().width, camera.size().height);
  FaceTable table(first_records(layers).back());
  PixelSights sight = look(layers, camera, table);
  const std::vector<LinearColor> lit = light_faces(layers, camera, table);
  const Painter painter(sight, table, lit, camera, haze_of(sight));
  for_each_row(sight.height, [&](int y) { painter.paint_row(image, y); });
  return {std::move(image), std::move(sight.distances)};
}

}  // namespace vdbmap
