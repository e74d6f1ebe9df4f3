// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace vdbmap {

/// Colour as cameras and files give it: non-linear sRGB, 0..65535 a channel (8-bit values times 257).
struct Rgb16 {
  std::uint16_t r = 0;
  std::uint16_t g = 0;
  std::uint16_t b = 0;

  bool operator==(const Rgb16&) const = default;
};

/// Points with the attributes their source knows. Every attribute is empty or as long as `positions`.
struct PointCloud {
  std::vector<Eigen::Vector3d> positions;  ///< [unit of the file, metres by convention], all finite
  std::vector<Rgb16> colors;
  std::vector<float> intensities;     ///< scale of the source
  std::vector<double> times;          ///< [s] epoch of the source
  std::vector<std::uint16_t> rings;   ///< laser number
  std::vector<std::uint16_t> labels;  ///< class number of the source

  std::size_t size() const { return positions.size(); }
  bool empty() const { return positions.empty(); }
};

}  // namespace vdbmap
