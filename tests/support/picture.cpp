// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/picture.h"

#include <stdexcept>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace vdbmap::test {

Image read_picture(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) throw std::runtime_error(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.nchannels != 3) throw std::runtime_error("expected three channels");
  std::vector<Rgb8> pixels(spec.image_pixels());
  if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data())) throw std::runtime_error(input->geterror());
  Image image(spec.width, spec.height);
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) image.at(x, y) = pixels[static_cast<std::size_t>(y * spec.width + x)];
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
