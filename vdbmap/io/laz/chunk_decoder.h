// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string_view>
#include <variant>

#include "vdbmap/io/laz/layered_decoder.h"
#include "vdbmap/io/laz/pointwise_decoder.h"

namespace vdbmap::laz {

/// No chunk holds more points a byte: even where each symbol of a point is all but certain, it costs a part of a bit.
/// Of the 7 symbols of a position and of what changes, the statistics leave at least 1/2^15 to each of the 32 lengths
/// and 63 changes that do not come, and 1/2^13 to the bit that does not: 0.0075 bits a point.
inline constexpr std::uint64_t kMostPointsPerByte = 1100;

/// Decodes a chunk of either compressor.
class ChunkDecoder {
 public:
  /// [bytes] below which no chunk of a file can be.
  static std::size_t least_size(const LaszipRecord& laszip);

  /// `bytes`, which must outlive the decoder, are at least least_size() long; layered ones as long as their front says.
  ChunkDecoder(const LaszipRecord& laszip, std::string_view bytes, LayerChoice choice);

  /// Writes the next `count` points, as records of an uncompressed file.
  void decode(char* records, std::size_t count);

  bool is_beyond_end() const;  ///< the bytes end before the points that were decoded
  bool is_at_end() const;      ///< the bytes end with the points that were decoded

 private:
  std::variant<PointwiseDecoder, LayeredDecoder> decoder_;
};

}  // namespace vdbmap::laz
