// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <vector>

namespace vdbmap {
namespace {

/// Whole pixels [left, right) x [top, bottom) of a picture.
struct PixelBox {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;

  bool empty() const { return left >= right || top >= bottom; }
};

int clamped(double value, int high) { return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(high))); }

PixelBox pixels_around(const Image& image, const Eigen::AlignedBox2d& box) {
  if (box.isEmpty() || !box.min().allFinite() || !box.max().allFinite()) return {};
  return {clamped(std::floor(box.min().x()), image.width()), clamped(std::floor(box.min().y()), image.height()),
          clamped(std::ceil(box.max().x()), image.width()), clamped(std::ceil(box.max().y()), image.height())};
}

Eigen::AlignedBox2d grown(Eigen::AlignedBox2d box, double margin) {
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

// Calls body(x, y, centre) for every pixel of the box.
template <typename Body>
void for_each_pixel(const PixelBox& box, const Body& body) {
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) body(x, y, Eigen::Vector2d(x + 0.5, y + 0.5));
  }
}

// An edge at that distance inside (positive) or outside (negative) of a pixel's centre.
double coverage_of(double distance_inside) { return std::clamp(distance_inside + 0.5, 0.0, 1.0); }

// Thinner than a pixel a line gets paler, not narrower.
struct Stroke {
  double radius;
  double opacity;
};

Stroke stroke_of(double width, double opacity) { return {std::max(width, 1.0) / 2, opacity * std::min(width, 1.0)}; }

double distance_to_segment(const Eigen::Vector2d& point, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0;
  return (point - from - t * along).norm();
}

/// How much of each pixel of a box is covered by several strokes together.
class CoverageMask {
 public:
  explicit CoverageMask(const PixelBox& box)
      : box_(box),
        width_(static_cast<std::size_t>(box.right - box.left)),
        coverage_(width_ * static_cast<std::size_t>(box.bottom - box.top), 0.0F) {}

  float& at(int x, int y) {
    return coverage_[static_cast<std::size_t>(y - box_.top) * width_ + static_cast<std::size_t>(x - box_.left)];
  }

  void blend_onto(Image& image, const Ink& ink) {
    for (int y = box_.top; y < box_.bottom; ++y) {
      for (int x = box_.left; x < box_.right; ++x) image.blend(x, y, ink.color, ink.opacity * at(x, y));
    }
  }

 private:
  PixelBox box_;
  std::size_t width_;
  std::vector<float> coverage_;
};

// The part of a row's pixels that a stroke can reach: a long slanting line then costs its length, not its box.
PixelBox row_of_stroke(const PixelBox& box, int y, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                       double reach) {
  const Eigen::Vector2d along = to - from;
  if (std::abs(along.y()) < 1) return {box.left, y, box.right, y + 1};
  const double slant = along.x() / along.y();
  const double middle = from.x() + (y + 0.5 - from.y()) * slant;
  const double spread = (reach + 1) * std::sqrt(1 + slant * slant) + 1;
  const int left = static_cast<int>(std::clamp(std::floor(middle - spread), double(box.left), double(box.right)));
  const int right = static_cast<int>(std::clamp(std::ceil(middle + spread), double(box.left), double(box.right)));
  return {left, y, right, y + 1};
}

void add_stroke(CoverageMask& mask, const Image& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                double radius) {
  Eigen::AlignedBox2d bounds(from);
  bounds.extend(to);
  const PixelBox box = pixels_around(image, grown(bounds, radius + 1));
  for (int y = box.top; y < box.bottom; ++y) {
    for_each_pixel(row_of_stroke(box, y, from, to, radius), [&](int x, int row, const Eigen::Vector2d& center) {
      const auto coverage = static_cast<float>(coverage_of(radius - distance_to_segment(center, from, to)));
      mask.at(x, row) = std::max(mask.at(x, row), coverage);
    });
  }
}

// How far a pixel of [i, i + 1) is covered by [low, high].
double overlap(int i, double low, double high) {
  return std::max(0.0, std::min(i + 1.0, high) - std::max(double(i), low));
}

}  // namespace

void draw_polyline(Image& image, std::span<const Eigen::Vector2d> points, double width, const Ink& ink) {
  std::vector<Eigen::Vector2d> finite;
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite), [](const auto& p) { return p.allFinite(); });
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& point : finite) bounds.extend(point);
  const Stroke stroke = stroke_of(width, ink.opacity);
  const PixelBox box = pixels_around(image, grown(bounds, stroke.radius + 1));
  if (finite.empty() || box.empty()) return;

  CoverageMask mask(box);
  for (std::size_t i = 0; i + 1 < finite.size(); ++i) add_stroke(mask, image, finite[i], finite[i + 1], stroke.radius);
  if (finite.size() == 1) add_stroke(mask, image, finite[0], finite[0], stroke.radius);
  mask.blend_onto(image, {ink.color, stroke.opacity});
}

void draw_line(Image& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width, const Ink& ink) {
  draw_polyline(image, std::array{from, to}, width, ink);
}

void draw_disc(Image& image, const Eigen::Vector2d& center, double radius, const Ink& ink) {
  const PixelBox box = pixels_around(image, grown(Eigen::AlignedBox2d(center), radius + 1));
  for_each_pixel(box, [&](int x, int y, const Eigen::Vector2d& pixel) {
    image.blend(x, y, ink.color, ink.opacity * coverage_of(radius - (pixel - center).norm()));
  });
}

void draw_ring(Image& image, const Eigen::Vector2d& center, double radius, double width, const Ink& ink) {
  const Stroke stroke = stroke_of(width, ink.opacity);
  const PixelBox box = pixels_around(image, grown(Eigen::AlignedBox2d(center), radius + stroke.radius + 1));
  for_each_pixel(box, [&](int x, int y, const Eigen::Vector2d& pixel) {
    const double off_middle = std::abs((pixel - center).norm() - radius);
    image.blend(x, y, ink.color, stroke.opacity * coverage_of(stroke.radius - off_middle));
  });
}

void fill_box(Image& image, const Eigen::AlignedBox2d& box, const Ink& ink) {
  for_each_pixel(pixels_around(image, box), [&](int x, int y, const Eigen::Vector2d&) {
    const double coverage = overlap(x, box.min().x(), box.max().x()) * overlap(y, box.min().y(), box.max().y());
    image.blend(x, y, ink.color, ink.opacity * coverage);
  });
}

void draw_box(Image& image, const Eigen::AlignedBox2d& box, double width, const Ink& ink) {
  if (box.isEmpty()) return;
  const Eigen::Vector2d low = box.min();
  const Eigen::Vector2d high = box.max();
  const double half = width / 2;
  const auto fill = [&](double left, double top, double right, double bottom) {
    fill_box(image, {Eigen::Vector2d(left, top), Eigen::Vector2d(right, bottom)}, ink);
  };
  fill(low.x() - half, low.y() - half, high.x() + half, low.y() + half);
  fill(low.x() - half, high.y() - half, high.x() + half, high.y() + half);
  fill(low.x() - half, low.y() + half, low.x() + half, high.y() - half);
  fill(high.x() - half, low.y() + half, high.x() + half, high.y() - half);
}

void fill_polygon(Image& image, std::span<const Eigen::Vector2d> corners, const Ink& ink) {
  Eigen::AlignedBox2d bounds;
  double doubled_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& next = corners[(i + 1) % corners.size()];
    doubled_area += corners[i].x() * next.y() - corners[i].y() * next.x();
    bounds.extend(corners[i]);
  }
  const double turn = doubled_area < 0 ? -1 : 1;
  for_each_pixel(pixels_around(image, grown(bounds, 1)), [&](int x, int y, const Eigen::Vector2d& pixel) {
    double inside = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d edge = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
      const Eigen::Vector2d offset = pixel - corners[i];
      inside = std::min(inside, turn * (edge.x() * offset.y() - edge.y() * offset.x()));
    }
    image.blend(x, y, ink.color, ink.opacity * coverage_of(inside));
  });
}

void copy_box(Image& target, const Image& source, const Eigen::AlignedBox2d& box) {
  const Eigen::AlignedBox2d whole(box.min().array().ceil(), box.max().array().floor());
  for_each_pixel(pixels_around(target, whole),
                 [&](int x, int y, const Eigen::Vector2d&) { target.at(x, y) = source.at(x, y); });
}

}  // namespace vdbmap
