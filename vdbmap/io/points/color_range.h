// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "vdbmap/io/points/point_fields.h"

namespace vdbmap {

/// What all colours of a file have in common. Programs write 8-bit colours into 16-bit fields and into floats, so their
/// scale is not what the field's type says but what the numbers are: floats up to 1 run from 0 to 1, other numbers up
/// to 255 are of 8 bits, and those above of 16 bits. That is LAS' convention: a picture of 16 bits none of whose
/// channels exceeds 255 of 65535 is taken for one of 8 bits.
class ColorRange {
 public:
  /// Adds channels as they stand in the file; NaN is none.
  void add(std::span<const double> channels);

  /// What 1 in the file is of 65535. `are_floats`: the file's numbers can have fractions.
  double scale(bool are_floats) const;

 private:
  double largest_ = 0;
  bool has_fractions_ = false;
};

/// Gives a colour field the scale that the file's colours say, unless its own is known.
void set_color_scale(PointField& field, const ColorRange& range);

/// Turns the whole numbers of a file's 16-bit fields into colours.
void scale_colors(std::vector<Rgb16>& colors);

}  // namespace vdbmap
