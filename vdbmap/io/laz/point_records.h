// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstring>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/laz/color_decoder.h"

namespace vdbmap::laz {

/// Writes a number where a file would have it, little endian.
template <Scalar T>
void store(char* bytes, T value) {
  if constexpr (std::endian::native != std::endian::little) value = swap_bytes(value);
  std::memcpy(bytes, &value, sizeof(T));
}

inline Channels load_channels(const char* bytes) {
  return {load<std::uint16_t>(bytes), load<std::uint16_t>(bytes + 2), load<std::uint16_t>(bytes + 4)};
}

inline void store_channels(char* bytes, const Channels& color) {
  for (std::size_t i = 0; i < color.size(); ++i) store(bytes + 2 * i, color[i]);
}

}  // namespace vdbmap::laz
