// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "vdbmap/io/laz/integer_decoder.h"

namespace vdbmap::laz {

/// Channels as the file has them: red, green, blue.
using Channels = std::array<std::uint16_t, 3>;

/// Statistics of the bytes of colours, of LASzip's versions 2 and 3: which bytes change, and by how much from what the
/// change of red, then of green, lets expect.
class ColorModels {
 public:
  /// The colour after `last`.
  Channels decode(ArithmeticDecoder& decoder, const Channels& last) {
    const unsigned changes = decoder.decode(changes_);
    Bytes low{&low_, changes, 0};
    Bytes high{&high_, changes, 1};
    const unsigned low_red = low.decode_red(decoder, last[0] & 0xff);
    const unsigned high_red = high.decode_red(decoder, last[0] >> 8);
    const auto red = static_cast<std::uint16_t>(low_red | high_red << 8);
    if ((changes & kIsColored) == 0) return {red, red, red};
    const unsigned low_green = low.decode_next(decoder, 1, last[1] & 0xff);
    const unsigned low_blue = low.decode_next(decoder, 2, last[2] & 0xff);
    const unsigned high_green = high.decode_next(decoder, 1, last[1] >> 8);
    const unsigned high_blue = high.decode_next(decoder, 2, last[2] >> 8);
    return {red, static_cast<std::uint16_t>(low_green | high_green << 8),
            static_cast<std::uint16_t>(low_blue | high_blue << 8)};
  }

 private:
  static constexpr unsigned kIsColored = 1 << 6;
  using ByteModels = std::array<SymbolModel<256>, 3>;

  // The low or the high bytes of the three channels; bits 2 c + `bit` of the changes are theirs.
  struct Bytes {
    ByteModels* models;
    unsigned changes;
    unsigned bit;
    int shift = 0;  // of the channel before, and of the mean of both before that

    bool is_changed(unsigned channel) const { return (changes >> (2 * channel + bit) & 1) != 0; }

    unsigned decode_red(ArithmeticDecoder& decoder, int last) {
      if (!is_changed(0)) return static_cast<unsigned>(last);
      const unsigned byte = (decoder.decode((*models)[0]) + static_cast<unsigned>(last)) & 0xff;
      shift = static_cast<int>(byte) - last;
      return byte;
    }

    unsigned decode_next(ArithmeticDecoder& decoder, unsigned channel, int last) {
      unsigned byte = static_cast<unsigned>(last);
      if (is_changed(channel)) {
        const auto expected = static_cast<unsigned>(std::clamp(last + shift, 0, 255));
        byte = (decoder.decode((*models)[channel]) + expected) & 0xff;
      }
      if (channel == 1) shift = (shift + static_cast<int>(byte) - last) / 2;
      return byte;
    }
  };

  SymbolModel<128> changes_;
  ByteModels low_;
  ByteModels high_;
};

/// The same of version 1: each byte by itself.
class ColorModels1 {
 public:
  Channels decode(ArithmeticDecoder& decoder, const Channels& last) {
    const unsigned changes = decoder.decode(changes_);
    Channels color = last;
    for (unsigned i = 0; i < 6; ++i) {
      if ((changes >> i & 1) == 0) continue;
      const unsigned shift = i % 2 * 8;
      const std::uint32_t byte = bytes_.decode(decoder, last[i / 2] >> shift & 0xff, i);
      color[i / 2] = static_cast<std::uint16_t>((color[i / 2] & ~(0xff << shift)) | byte << shift);
    }
    return color;
  }

 private:
  SymbolModel<64> changes_;
  IntegerDecoder<8> bytes_{6};
};

}  // namespace vdbmap::laz
