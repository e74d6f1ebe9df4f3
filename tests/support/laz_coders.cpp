// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/laz_coders.h"

namespace vdbmap::test {

void ArithmeticEncoder::encode_bit(laz::BitModel& model, bool bit) {
  const std::uint32_t zeros = model.zeros() * (length_ >> laz::kBitShareBits);
  narrow(bit ? zeros : 0, bit ? length_ - zeros : zeros);
  model.count(bit);
}

void ArithmeticEncoder::encode_bits(std::uint32_t bits, unsigned count) {
  if (count > 19) {
    encode_bits(bits & 0xffff, 16);
    return encode_bits(bits >> 16, count - 16);
  }
  const std::uint32_t unit = length_ >> count;
  narrow(bits * unit, unit);
}

void ArithmeticEncoder::encode_64_bits(std::uint64_t bits) {
  encode_bits(static_cast<std::uint32_t>(bits), 32);
  encode_bits(static_cast<std::uint32_t>(bits >> 32), 32);
}

std::string ArithmeticEncoder::finish() {
  constexpr std::uint32_t kShortest = 1 << 24;
  const bool is_long = length_ > 2 * kShortest;
  narrow(is_long ? kShortest : kShortest >> 1, is_long ? kShortest >> 1 : kShortest >> 9);
  // As many bytes more as the decoder has read ahead.
  return bytes_ + std::string(is_long ? 3 : 2, '\0');
}

void ArithmeticEncoder::narrow(std::uint32_t begin, std::uint32_t length) {
  base_ += begin;
  if (base_ < begin) carry();
  length_ = length;
  renormalize();
}

void ArithmeticEncoder::carry() {
  for (auto byte = bytes_.rbegin(); byte != bytes_.rend(); ++byte) {
    *byte = static_cast<char>(*byte + 1);
    if (*byte != 0) return;
  }
}

void ArithmeticEncoder::renormalize() {
  while (length_ < 1 << 24) {
    bytes_ += static_cast<char>(base_ >> 24);
    base_ <<= 8;
    length_ <<= 8;
  }
}

}  // namespace vdbmap::test
