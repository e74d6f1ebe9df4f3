// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/region_outlines.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vdbmap/change/change_colors.h"
#include "vdbmap/render/decoration.h"
#include "vdbmap/render/draw.h"
#include "vdbmap/render/overlay.h"
#include "vdbmap/render/text.h"

namespace vdbmap {
namespace {

constexpr double kOutlineGap = 0.2;       // [m] between a region and its outline
constexpr std::size_t kMostNumbers = 40;  // of the largest regions
constexpr double kDarkness = 0.72;        // of outlines: they lie on voxels of their colour

Rgb8 outline_color(Change kind) {
  const Rgb8 color = rgb8(color_code_of(kind));
  const auto darker = [](std::uint8_t value) { return static_cast<std::uint8_t>(kDarkness * value); };
  return {darker(color.r), darker(color.g), darker(color.b)};
}

// The four corners of a region's box at a height, the first once more at the end [m, local frame].
std::vector<Eigen::Vector3d> ring_of(const ChangeRegion& region, double height, const Eigen::Vector3d& anchor) {
  PlanRectangle plan = region.plan;
  plan.length += 2 * kOutlineGap;
  plan.width += 2 * kOutlineGap;
  std::vector<Eigen::Vector3d> ring;
  for (const Eigen::Vector2d& corner : plan.corners()) {
    ring.push_back(Eigen::Vector3d(corner.x(), corner.y(), height) - anchor);
  }
  ring.push_back(ring.front());
  return ring;
}

PathOverlay outline_of(const ChangeRegion& region, const Eigen::Vector3d& anchor, bool is_flat) {
  PathOverlay outline{"", {ring_of(region, region.top + kOutlineGap, anchor)}, outline_color(region.kind)};
  if (is_flat) return outline;
  outline.pieces.push_back(ring_of(region, region.bottom, anchor));
  for (std::size_t i = 0; i < 4; ++i) outline.pieces.push_back({outline.pieces[0][i], outline.pieces[1][i]});
  return outline;
}

void draw_number(Image& image, const Eigen::Vector2d& place, const ChangeRegion& region, int size) {
  const std::string text = std::to_string(region.id);
  const TextStyle style{.size = size, .ink = {rgb8(0xffffff)}, .align = TextAlign::kCenter, .is_bold = true};
  const double radius = std::max(0.5 * text_width(text, style) + 0.3 * size, 0.85 * size);
  draw_disc(image, place, radius + 1.5, {rgb8(0xffffff)});
  draw_disc(image, place, radius, {outline_color(region.kind)});
  draw_text(image, place, text, style);
}

bool is_in(const Image& image, const Eigen::Vector2d& place) {
  return place.x() >= 0 && place.y() >= 0 && place.x() < image.width() && place.y() < image.height();
}

}  // namespace

void draw_regions(VoxelView& view, const Camera& camera, std::span<const ChangeRegion> regions,
                  const Eigen::Vector3d& anchor) {
  const int size = std::max(11, letter_size(camera.size()) * 3 / 4);
  const bool is_flat = !camera.is_perspective() && camera.map_from_camera().linear()(2, 2) < -0.99;
  for (std::size_t i = regions.size(); i-- > 0;) {
    draw_path(view, camera, outline_of(regions[i], anchor, is_flat), std::max(1.2, size / 14.0));
  }
  for (std::size_t i = std::min(regions.size(), kMostNumbers); i-- > 0;) {
    const ChangeRegion& region = regions[i];
    const Eigen::Vector3d top(region.center().x(), region.center().y(), region.top + 0.6);
    const std::optional<ImagePoint> place = camera.project(top - anchor);
    if (place && is_in(view.image, place->pixel)) draw_number(view.image, place->pixel, region, size);
  }
}

}  // namespace vdbmap
