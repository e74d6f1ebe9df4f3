// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vdbmap/io/laz/symbol_model.h"

namespace vdbmap::test {

/// Writes what laz::ArithmeticDecoder reads: Said's arithmetic coder of 32 bits, whose last bytes are as LASzip's.
class ArithmeticEncoder {
 public:
  template <unsigned kCapacity>
  void encode(laz::SymbolModel<kCapacity>& model, unsigned symbol) {
    const std::uint32_t unit = length_ >> laz::kShareBits;
    const std::uint32_t begin = model.start(symbol) * unit;
    const std::uint32_t end = symbol == model.last() ? length_ : model.start(symbol + 1) * unit;
    narrow(begin, end - begin);
    model.count(symbol);
  }

  void encode_bit(laz::BitModel& model, bool bit);
  void encode_bits(std::uint32_t bits, unsigned count);
  void encode_64_bits(std::uint64_t bits);

  /// The code of all that was encoded; nothing can be encoded afterwards.
  std::string finish();

 private:
  void narrow(std::uint32_t begin, std::uint32_t length);
  void carry();
  void renormalize();

  std::string bytes_;
  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xffffffff;
};

/// Writes what laz::IntegerDecoder reads.
template <unsigned kBits>
class IntegerEncoder {
 public:
  explicit IntegerEncoder(unsigned num_contexts = 1) : lengths_(num_contexts) {}

  void encode(ArithmeticEncoder& encoder, std::uint32_t predicted, std::uint32_t number, unsigned context = 0) {
    std::int64_t difference = static_cast<std::int32_t>((number - predicted) << (32 - kBits)) >> (32 - kBits);
    length_ = 0;
    for (std::int64_t rest = difference <= 0 ? -difference : difference - 1; rest != 0; rest /= 2) ++length_;
    encoder.encode(lengths_[context], length_);
    if (length_ == 0) return encoder.encode_bit(one_, difference != 0);
    if (length_ == 32) return;
    const std::int64_t place = difference < 0 ? difference + (std::int64_t{1} << length_) - 1 : difference - 1;
    encode_place(encoder, static_cast<std::uint32_t>(place));
  }

  unsigned length() const { return length_; }

 private:
  void encode_place(ArithmeticEncoder& encoder, std::uint32_t place) {
    if (length_ <= 8) return encoder.encode(places_.at(length_, 1U << length_), place);
    const unsigned num_plain = length_ - 8;
    encoder.encode(places_.at(length_), place >> num_plain);
    encoder.encode_bits(place & ((1U << num_plain) - 1), num_plain);
  }

  unsigned length_ = 0;
  std::vector<laz::SymbolModel<kBits + 1>> lengths_;
  laz::BitModel one_;
  laz::ModelSet<kBits + 1, 256> places_;
};

}  // namespace vdbmap::test
