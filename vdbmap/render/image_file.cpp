// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/render/image.h"
#include "vdbmap/render/picture_module.h"

namespace vdbmap {

namespace {

std::string encode(const Image& image, PictureFormat format) {
  std::string bytes;
  const std::string failure = picture_module().encode(image, format, bytes);
  if (!failure.empty()) throw std::runtime_error("cannot encode a picture: " + failure);
  return bytes;
}

PictureFormat format_of_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".jpg" || ending == ".jpeg" ? PictureFormat::kJpeg : PictureFormat::kPng;
}

}  // namespace

std::string png_of(const Image& image) { return encode(image, PictureFormat::kPng); }

void write_png(const std::filesystem::path& path, const Image& image) { write_file(path, png_of(image)); }

void write_picture(const std::filesystem::path& path, const Image& image) {
  write_file(path, encode(image, format_of_ending(path)));
}

}  // namespace vdbmap
