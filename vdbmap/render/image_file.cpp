// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "vdbmap/io/atomic_file.h"
#include "vdbmap/render/image.h"
#include "vdbmap/render/picture_module.h"

namespace vdbmap {

std::string png_of(const Image& image) {
  std::string bytes;
  const std::string failure = picture_module().encode_png(image, bytes);
  if (!failure.empty()) throw std::runtime_error("cannot encode a PNG: " + failure);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) { write_file(path, png_of(image)); }

}  // namespace vdbmap
