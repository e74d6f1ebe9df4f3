// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "vdbmap/io/laz/laszip_record.h"

namespace vdbmap::laz {

/// Which of the layers of a chunk are decoded. Those of a cloud: all but scan angles, user data, sources, near infrared
/// and extra bytes, which keep the values of the chunk's first point.
enum class LayerChoice { kOfCloud, kAll };

/// What stands at the front of a layered chunk.
struct LayeredChunkFront {
  std::uint64_t num_points = 0;
  std::uint64_t size = 0;  ///< [bytes] of the chunk with all of its layers
};

/// Nothing where `bytes`, which begin with a chunk, end before the sizes of its layers.
std::optional<LayeredChunkFront> read_layered_chunk_front(const LaszipRecord& laszip, std::string_view bytes);

/// Decodes a chunk of LASzip's layered compressor: point formats 6 to 8, versions 3 and 4. The first point stands there
/// as it is; then come the sizes of the layers, and the layers, each a code of its own.
class LayeredDecoder {
 public:
  /// [bytes] of the front of a chunk.
  static std::size_t least_size(const LaszipRecord& laszip);

  /// `chunk` must be as long as its front says, and outlive the decoder.
  LayeredDecoder(const LaszipRecord& laszip, std::string_view chunk, LayerChoice choice);
  ~LayeredDecoder();
  LayeredDecoder(LayeredDecoder&&) noexcept;
  LayeredDecoder& operator=(LayeredDecoder&&) noexcept;

  /// Writes the next `count` points, as records of an uncompressed file.
  void decode(char* records, std::size_t count);

  bool is_beyond_end() const;  ///< a decoded layer ends before the points that were decoded
  bool is_at_end() const;      ///< all decoded layers end with the points that were decoded

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vdbmap::laz
