// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "vdbmap/io/laz/integer_decoder.h"
#include "vdbmap/io/laz/point_records.h"
#include "vdbmap/io/laz/return_contexts.h"
#include "vdbmap/io/laz/running_median.h"

namespace vdbmap::laz {

/// The part that all of the formats have (LAS 1.4-R15, table 7).
struct Point {
  static constexpr std::size_t kSize = 20;  // [bytes]

  std::uint32_t x = 0;  // so that sums of damaged differences may overflow
  std::uint32_t y = 0;
  std::uint32_t z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t returns = 0;  // 3 bits of the number, 3 of how many there are, scan direction, edge
  std::uint8_t classification = 0;
  std::uint8_t scan_angle = 0;
  std::uint8_t user_data = 0;
  std::uint16_t source = 0;

  unsigned number() const { return returns & 7; }
  unsigned num_returns() const { return returns >> 3 & 7; }
  unsigned scan_direction() const { return returns >> 6 & 1; }
};

inline Point load_point(const char* record) {
  Point point;
  point.x = load<std::uint32_t>(record);
  point.y = load<std::uint32_t>(record + 4);
  point.z = load<std::uint32_t>(record + 8);
  point.intensity = load<std::uint16_t>(record + 12);
  point.returns = load<std::uint8_t>(record + 14);
  point.classification = load<std::uint8_t>(record + 15);
  point.scan_angle = load<std::uint8_t>(record + 16);
  point.user_data = load<std::uint8_t>(record + 17);
  point.source = load<std::uint16_t>(record + 18);
  return point;
}

inline void store_point(char* record, const Point& point) {
  store(record, point.x);
  store(record + 4, point.y);
  store(record + 8, point.z);
  store(record + 12, point.intensity);
  store(record + 14, point.returns);
  store(record + 15, point.classification);
  store(record + 16, point.scan_angle);
  store(record + 17, point.user_data);
  store(record + 18, point.source);
}

/// What of the point changed: bits of a symbol. Versions differ in which is which.
struct ChangeBits {
  unsigned returns;
  unsigned intensity;
  unsigned classification = 8;
  unsigned scan_angle = 4;
  unsigned user_data = 2;
  unsigned source = 1;
};

/// Bytes whose next value depends on the last one.
class ByteChain {
 public:
  std::uint8_t decode(ArithmeticDecoder& decoder, std::uint8_t last) {
    return static_cast<std::uint8_t>(decoder.decode(models_.at(last)));
  }

 private:
  ModelSet<256, 256> models_;
};

/// Version 2: coordinates after all else, by the contexts of the return.
class PointDecoder2 {
 public:
  explicit PointDecoder2(const Point& first) : last_(first) { last_.intensity = 0; }

  const Point& decode(ArithmeticDecoder& decoder) {
    if (const unsigned changes = decoder.decode(changes_)) decode_attributes(decoder, changes);
    decode_position(decoder);
    return last_;
  }

 private:
  static constexpr ChangeBits kBits{.returns = 32, .intensity = 16};

  unsigned context() const { return kReturnContexts16[last_.num_returns()][last_.number()]; }

  void decode_attributes(ArithmeticDecoder& decoder, unsigned changes) {
    if (changes & kBits.returns) last_.returns = returns_.decode(decoder, last_.returns);
    decode_intensity(decoder, (changes & kBits.intensity) != 0);
    if (changes & kBits.classification) {
      last_.classification = classifications_.decode(decoder, last_.classification);
    }
    if (changes & kBits.scan_angle) {
      const unsigned difference = decoder.decode(scan_angles_[last_.scan_direction()]);
      last_.scan_angle = static_cast<std::uint8_t>(last_.scan_angle + difference);
    }
    if (changes & kBits.user_data) last_.user_data = user_data_.decode(decoder, last_.user_data);
    if (changes & kBits.source) last_.source = static_cast<std::uint16_t>(sources_.decode(decoder, last_.source));
  }

  void decode_intensity(ArithmeticDecoder& decoder, bool is_changed) {
    std::uint16_t& last = last_intensities_[context()];
    if (is_changed) {
      last = static_cast<std::uint16_t>(intensities_.decode(decoder, last, std::min(context(), 3U)));
    }
    last_.intensity = last;
  }

  void decode_position(ArithmeticDecoder& decoder) {
    const bool is_only = last_.num_returns() == 1;
    RunningMedian& x_step = x_steps_[context()];
    RunningMedian& y_step = y_steps_[context()];
    const std::uint32_t dx = x_.decode(decoder, static_cast<std::uint32_t>(x_step.value()), is_only ? 1 : 0);
    const std::uint32_t dy =
        y_.decode(decoder, static_cast<std::uint32_t>(y_step.value()), length_context(x_.length(), 20, is_only));
    x_step.add(static_cast<std::int32_t>(dx));
    y_step.add(static_cast<std::int32_t>(dy));
    last_.x += dx;
    last_.y += dy;

    std::uint32_t& height = last_heights_[return_level(last_.num_returns(), last_.number())];
    height = z_.decode(decoder, height, length_context((x_.length() + y_.length()) / 2, 18, is_only));
    last_.z = height;
  }

  Point last_;
  std::array<RunningMedian, 16> x_steps_;
  std::array<RunningMedian, 16> y_steps_;
  std::array<std::uint32_t, 8> last_heights_{};
  std::array<std::uint16_t, 16> last_intensities_{};
  SymbolModel<64> changes_;
  IntegerDecoder<32> x_{2};
  IntegerDecoder<32> y_{22};
  IntegerDecoder<32> z_{20};
  IntegerDecoder<16> intensities_{4};
  IntegerDecoder<16> sources_;
  std::array<SymbolModel<256>, 2> scan_angles_;
  ByteChain returns_;
  ByteChain classifications_;
  ByteChain user_data_;
};

/// Version 1: coordinates first, by the median of three steps.
class PointDecoder1 {
 public:
  explicit PointDecoder1(const Point& first) : last_(first) {}

  const Point& decode(ArithmeticDecoder& decoder) {
    const unsigned length = decode_position(decoder);
    if (const unsigned changes = decoder.decode(changes_)) decode_attributes(decoder, changes, length);
    return last_;
  }

 private:
  static constexpr ChangeBits kBits{.returns = 16, .intensity = 32};
  static constexpr unsigned kHighestContext = 19;
  using Steps = std::array<std::uint32_t, 3>;

  static std::uint32_t median(const Steps& steps) {
    const auto a = static_cast<std::int32_t>(steps[0]);
    const auto b = static_cast<std::int32_t>(steps[1]);
    const auto c = static_cast<std::int32_t>(steps[2]);
    return static_cast<std::uint32_t>(std::max(std::min(a, b), std::min(std::max(a, b), c)));
  }

  // Returns the bits that steps in x and y take.
  unsigned decode_position(ArithmeticDecoder& decoder) {
    const std::uint32_t dx = x_.decode(decoder, median(x_steps_));
    const std::uint32_t dy = y_.decode(decoder, median(y_steps_), std::min(x_.length(), kHighestContext));
    const unsigned length = (x_.length() + y_.length()) / 2;
    last_.x += dx;
    last_.y += dy;
    last_.z = z_.decode(decoder, last_.z, std::min(length, kHighestContext));
    x_steps_[oldest_step_] = dx;
    y_steps_[oldest_step_] = dy;
    oldest_step_ = (oldest_step_ + 1) % x_steps_.size();
    return length;
  }

  void decode_attributes(ArithmeticDecoder& decoder, unsigned changes, unsigned length) {
    if (changes & kBits.intensity) {
      last_.intensity = static_cast<std::uint16_t>(intensities_.decode(decoder, last_.intensity));
    }
    if (changes & kBits.returns) last_.returns = returns_.decode(decoder, last_.returns);
    if (changes & kBits.classification) {
      last_.classification = classifications_.decode(decoder, last_.classification);
    }
    if (changes & kBits.scan_angle) {
      last_.scan_angle = static_cast<std::uint8_t>(scan_angles_.decode(decoder, last_.scan_angle, length < 3 ? 1 : 0));
    }
    if (changes & kBits.user_data) last_.user_data = user_data_.decode(decoder, last_.user_data);
    if (changes & kBits.source) last_.source = static_cast<std::uint16_t>(sources_.decode(decoder, last_.source));
  }

  Point last_;
  Steps x_steps_{};
  Steps y_steps_{};
  std::size_t oldest_step_ = 0;
  SymbolModel<64> changes_;
  IntegerDecoder<32> x_;
  IntegerDecoder<32> y_{20};
  IntegerDecoder<32> z_{20};
  IntegerDecoder<16> intensities_;
  IntegerDecoder<8> scan_angles_{2};
  IntegerDecoder<16> sources_;
  ByteChain returns_;
  ByteChain classifications_;
  ByteChain user_data_;
};

}  // namespace vdbmap::laz
