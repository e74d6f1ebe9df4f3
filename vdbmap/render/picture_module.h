// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "vdbmap/render/image.h"

namespace vdbmap {

/// A line of letters.
struct TextLine {
  std::string text;
  int size;  ///< [pixels] of the font
  bool is_bold;
};

/// Pixels [left, right) x [top, bottom), seen from the left end of the baseline.
struct TextExtent {
  int left;
  int top;
  int right;
  int bottom;
};

enum class PictureFormat { kPng, kJpeg };

/// What is done by OpenImageIO. It stands in a module of its own, loaded when the first picture is written or lettered:
/// Debian's OpenImageIO brings 240 libraries along, and every command would start 0.15 s later.
struct PictureModule {
  /// Fails with a reason, else sets `bytes` and returns "".
  std::string (*encode)(const Image& image, PictureFormat format, std::string& bytes);

  /// False where the font is missing.
  bool (*measure_text)(const TextLine& line, TextExtent& extent);

  /// Sets how much of each pixel is covered, 0..1, of the pixels around the text.
  void (*cover_text)(const TextLine& line, const TextExtent& around, float* coverage);
};

/// Loads the module at the first call. Throws std::runtime_error where it cannot be found.
const PictureModule& picture_module();

}  // namespace vdbmap
