// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>

#include "vdbmap/io/laz/symbol_model.h"

namespace vdbmap::laz {

/// Reads what Said's arithmetic coder of 32 bits wrote ("Introduction to Arithmetic Coding", HP Labs HPL-2004-76). Any
/// bytes can be decoded, to whatever symbols: what came of damaged ones is known by is_at_end() alone. Small enough to
/// be copied into a loop and back, so that it lives in registers there.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;

  /// `bytes` must outlive the decoder.
  explicit ArithmeticDecoder(std::string_view bytes) : next_(bytes.data()), end_(bytes.data() + bytes.size()) {
    for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next_byte();
    value_ = std::min(value_, length_ - 1);  // as in what an encoder writes
  }

  /// Whether all bytes are used and no more: so the encoder leaves it after its last symbol.
  bool is_at_end() const { return next_ == end_ && num_missing_ == 0; }
  /// Whether symbols were decoded that the bytes do not hold.
  bool is_beyond_end() const { return num_missing_ > 0; }
  /// The byte after those used so far.
  const char* next() const { return next_; }

  template <unsigned kCapacity>
  unsigned decode(SymbolModel<kCapacity>& model) {
    const std::uint32_t unit = length_ >> kShareBits;
    const unsigned symbol = model.find(value_ / unit);
    const std::uint32_t begin = model.start(symbol) * unit;
    const std::uint32_t end = symbol == model.last() ? length_ : model.start(symbol + 1) * unit;
    narrow(begin, end - begin);
    model.count(symbol);
    return symbol;
  }

  bool decode_bit(BitModel& model) {
    const std::uint32_t zeros = model.zeros() * (length_ >> kBitShareBits);
    const bool bit = value_ >= zeros;
    narrow(bit ? zeros : 0, bit ? length_ - zeros : zeros);
    model.count(bit);
    return bit;
  }

  /// `count` bits, 1 to 32, all of which are equally likely.
  std::uint32_t decode_bits(unsigned count) {
    constexpr unsigned kMostAtOnce = 19;
    if (count <= kMostAtOnce) return decode_few_bits(count);
    const std::uint32_t low = decode_few_bits(16);
    return decode_few_bits(count - 16) << 16 | low;
  }

  std::uint64_t decode_64_bits() {
    const std::uint64_t low = decode_bits(32);
    return std::uint64_t{decode_bits(32)} << 32 | low;
  }

 private:
  std::uint32_t decode_few_bits(unsigned count) {
    const std::uint32_t unit = length_ >> count;
    const std::uint32_t bits = value_ / unit;
    value_ -= bits * unit;
    length_ = unit;
    renormalize();
    return bits & ((1U << count) - 1);
  }

  // The interval of the symbol that was found, which begins `begin` above that of before.
  void narrow(std::uint32_t begin, std::uint32_t length) {
    value_ -= begin;
    length_ = length;
    renormalize();
  }

  void renormalize() {
    constexpr std::uint32_t kShortest = 1 << 24;
    while (length_ < kShortest) {
      value_ = value_ << 8 | next_byte();
      length_ <<= 8;
    }
  }

  std::uint32_t next_byte() {
    if (next_ != end_) return static_cast<unsigned char>(*next_++);
    ++num_missing_;
    return 0;
  }

  const char* next_ = nullptr;
  const char* end_ = nullptr;
  std::uint32_t value_ = 0;  // of the code above the interval's begin, always below its length
  std::uint32_t length_ = 0xffffffff;
  std::uint32_t num_missing_ = 0;  // bytes that were asked for after the last
};

}  // namespace vdbmap::laz
