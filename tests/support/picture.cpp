// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/picture.h"

#include <stdexcept>
#include <vector>

#include <png.h>

namespace vdbmap::test {

Image read_picture(const std::filesystem::path& path) {
  png_image file{};
  file.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&file, path.c_str())) throw std::runtime_error(file.message);
  if (file.format != PNG_FORMAT_RGB) throw std::runtime_error("expected three channels of 8 bits");
  static_assert(sizeof(Rgb8) == 3);
  std::vector<Rgb8> pixels(static_cast<std::size_t>(file.width) * file.height);
  if (!png_image_finish_read(&file, nullptr, pixels.data(), 0, nullptr)) throw std::runtime_error(file.message);
  Image image(static_cast<int>(file.width), static_cast<int>(file.height));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) image.at(x, y) = pixels[static_cast<std::size_t>(y * image.width() + x)];
  }
  return image;
}

std::size_t count_pixels(const Image& image, Rgb8 color) {
  return count_pixels(image, color, {Eigen::Vector2i(0, 0), Eigen::Vector2i(image.width() - 1, image.height() - 1)});
}

std::size_t count_pixels(const Image& image, Rgb8 color, const Eigen::AlignedBox2i& box) {
  std::size_t count = 0;
  for (int y = box.min().y(); y <= box.max().y(); ++y) {
    for (int x = box.min().x(); x <= box.max().x(); ++x) count += image.at(x, y) == color ? 1 : 0;
  }
  return count;
}

}  // namespace vdbmap::test
