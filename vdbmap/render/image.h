// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vdbmap {

/// A pixel, sRGB.
struct Rgb8 {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  bool operator==(const Rgb8&) const = default;
};

/// The colour of a web page's code: rgb8(0xff8000).
constexpr Rgb8 rgb8(std::uint32_t code) {
  return {static_cast<std::uint8_t>(code >> 16), static_cast<std::uint8_t>(code >> 8), static_cast<std::uint8_t>(code)};
}

/// Pictures have from 1 to this many pixels a side.
inline constexpr int kMaxImageSize = 16384;

/// An opaque picture: rows from the top, pixels from the left. Pixel (x, y) covers [x, x + 1) x [y, y + 1).
class Image {
 public:
  /// Throws std::invalid_argument unless both sides lie in [1, kMaxImageSize].
  Image(int width, int height, Rgb8 background = {255, 255, 255});

  int width() const { return width_; }
  int height() const { return height_; }
  Rgb8 at(int x, int y) const { return pixels_[index(x, y)]; }
  Rgb8& at(int x, int y) { return pixels_[index(x, y)]; }
  std::span<const Rgb8> pixels() const { return pixels_; }

  /// Lays a colour over a pixel; coverage 0 leaves it, 1 replaces it. Outside of the picture nothing happens.
  void blend(int x, int y, Rgb8 color, double coverage);

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<Rgb8> pixels_;
};

/// The picture as a PNG file: the same bytes for the same pixels.
std::string png_of(const Image& image);

/// Writes a PNG file atomically. Throws IoError.
void write_png(const std::filesystem::path& path, const Image& image);

/// Writes a picture atomically, in the format that its ending stands for: a JPEG file where that is .jpg or .jpeg, in
/// upper or lower case, else a PNG file. Throws IoError.
void write_picture(const std::filesystem::path& path, const Image& image);

}  // namespace vdbmap
