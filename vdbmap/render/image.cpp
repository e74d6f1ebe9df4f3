// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vdbmap {
namespace {

void check_side(const char* name, int size) {
  if (size >= 1 && size <= kMaxImageSize) return;
  throw std::invalid_argument(std::string(name) + " of the picture is " + std::to_string(size) +
                              " pixels, expected 1 to " + std::to_string(kMaxImageSize));
}

std::uint8_t mix(std::uint8_t below, std::uint8_t above, double coverage) {
  return static_cast<std::uint8_t>(std::lround(below + (above - below) * coverage));
}

}  // namespace

Image::Image(int width, int height, Rgb8 background) : width_(width), height_(height) {
  check_side("width", width);
  check_side("height", height);
  pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background);
}

void Image::blend(int x, int y, Rgb8 color, double coverage) {
  if (x < 0 || x >= width_ || y < 0 || y >= height_) return;
  if (!(coverage > 0)) return;
  coverage = std::min(coverage, 1.0);
  Rgb8& pixel = at(x, y);
  pixel = {mix(pixel.r, color.r, coverage), mix(pixel.g, color.g, coverage), mix(pixel.b, color.b, coverage)};
}

}  // namespace vdbmap
