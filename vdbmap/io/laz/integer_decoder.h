// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "vdbmap/io/laz/arithmetic_decoder.h"

namespace vdbmap::laz {

/// Symbols of the first bits of a number of so many bits; the rest of it is stored as it is.
inline constexpr unsigned kModelledBits = 8;

/// Reads integers of `kBits` that were written as differences from predictions: first how many bits the difference has,
/// by the statistics of one of several contexts, then which one of that length it is.
template <unsigned kBits>
class IntegerDecoder {
 public:
  explicit IntegerDecoder(unsigned num_contexts = 1) : lengths_(num_contexts) {}

  /// The number modulo 2^kBits.
  std::uint32_t decode(ArithmeticDecoder& decoder, std::uint32_t predicted, unsigned context = 0) {
    constexpr std::uint32_t kMask = 0xffffffffU >> (32 - kBits);
    return (predicted + decode_difference(decoder, context)) & kMask;
  }

  /// [bits] of the difference that was read last; predicts those of others.
  unsigned length() const { return length_; }

 private:
  // Lengths n > 0 stand for -(2^n - 1) .. -2^(n-1) and 2^(n-1) + 1 .. 2^n; 0 for 0 and 1; 32 for the lowest alone.
  std::uint32_t decode_difference(ArithmeticDecoder& decoder, unsigned context) {
    length_ = decoder.decode(lengths_[context]);
    if (length_ == 0) return decoder.decode_bit(one_) ? 1 : 0;
    if (length_ == 32) return 0x80000000U;
    const std::uint32_t place = decode_place(decoder);
    return place >= 1U << (length_ - 1) ? place + 1 : place - ((1U << length_) - 1);
  }

  std::uint32_t decode_place(ArithmeticDecoder& decoder) {
    if (length_ <= kModelledBits) return decoder.decode(places_.at(length_, 1U << length_));
    const unsigned num_plain = length_ - kModelledBits;
    const std::uint32_t high = decoder.decode(places_.at(length_));
    return high << num_plain | decoder.decode_bits(num_plain);
  }

  unsigned length_ = 0;
  std::vector<SymbolModel<kBits + 1>> lengths_;
  BitModel one_;
  ModelSet<kBits + 1, 1 << kModelledBits> places_;
};

}  // namespace vdbmap::laz
