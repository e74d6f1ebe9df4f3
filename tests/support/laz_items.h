// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "tests/support/laz_coders.h"
#include "vdbmap/io/laz/color_decoder.h"

namespace vdbmap::test {

/// Writes GPS times as laz::GpsTimeDecoder reads them.
template <bool kHasUnchanged>
class GpsTimeEncoder {
 public:
  explicit GpsTimeEncoder(std::uint64_t first) { sequences_[0].time = first; }

  void encode(ArithmeticEncoder& encoder, std::uint64_t time);

 private:
  static constexpr unsigned kLeftOut = kHasUnchanged ? 0 : 1;

  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t interval = 0;
    unsigned num_exceptions = 0;
  };

  Sequence& current() { return sequences_[last_]; }
  // Of the sequence that is so many after the current one; nothing where 32 bits do not hold it.
  bool fits(std::uint64_t time, unsigned step) const;
  void encode_symbol(ArithmeticEncoder& encoder, unsigned without_interval, unsigned with_interval);
  void encode_multiple(ArithmeticEncoder& encoder, std::int32_t difference);
  void encode_exception(ArithmeticEncoder& encoder, std::int32_t difference);

  std::array<Sequence, 4> sequences_;
  unsigned last_ = 0;
  unsigned newest_ = 0;
  laz::SymbolModel<6 - kLeftOut> without_interval_;
  laz::SymbolModel<516 - kLeftOut> multiples_;
  IntegerEncoder<32> integers_{9};
};

extern template class GpsTimeEncoder<false>;
extern template class GpsTimeEncoder<true>;

/// The same of version 1.
class GpsTimeEncoder1 {
 public:
  explicit GpsTimeEncoder1(std::uint64_t first) : time_(first) {}
  void encode(ArithmeticEncoder& encoder, std::uint64_t time);

 private:
  std::uint64_t time_;
  std::int32_t interval_ = 0;
  unsigned num_exceptions_ = 0;
  laz::SymbolModel<3> without_interval_;
  laz::SymbolModel<512> multiples_;
  IntegerEncoder<32> integers_{6};
};

/// Writes a colour as laz::ColorModels reads it.
class ColorEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, const laz::Channels& last, const laz::Channels& color);

 private:
  laz::SymbolModel<128> changes_;
  std::array<laz::SymbolModel<256>, 6> bytes_;  // low and high of red, of green, of blue
};

/// The same of version 1.
class ColorEncoder1 {
 public:
  void encode(ArithmeticEncoder& encoder, const laz::Channels& last, const laz::Channels& color);

 private:
  laz::SymbolModel<64> changes_;
  IntegerEncoder<8> bytes_{6};
};

}  // namespace vdbmap::test
