// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/laz_items.h"

#include <algorithm>
#include <cmath>

namespace vdbmap::test {
namespace {

// The nearest multiple of an interval.
int nearest_multiple(std::int32_t difference, std::int32_t interval) {
  const float multiple = static_cast<float>(difference) / static_cast<float>(interval);
  return static_cast<int>(std::clamp(std::round(multiple), -1000.f, 1000.f));
}

bool fits_in_32_bits(std::uint64_t difference) {
  return static_cast<std::int64_t>(difference) == static_cast<std::int32_t>(difference);
}

int byte_of(const laz::Channels& color, unsigned index) { return color[index / 2] >> index % 2 * 8 & 0xff; }

unsigned changed_bytes(const laz::Channels& last, const laz::Channels& color) {
  unsigned changes = 0;
  for (unsigned i = 0; i < 6; ++i) changes |= (byte_of(last, i) != byte_of(color, i) ? 1U : 0U) << i;
  return changes;
}

}  // namespace

template <bool kHasUnchanged>
bool GpsTimeEncoder<kHasUnchanged>::fits(std::uint64_t time, unsigned step) const {
  return fits_in_32_bits(time - sequences_[(last_ + step) % 4].time);
}

template <bool kHasUnchanged>
void GpsTimeEncoder<kHasUnchanged>::encode_symbol(ArithmeticEncoder& encoder, unsigned without_interval,
                                                  unsigned with_interval) {
  if (current().interval == 0) {
    encoder.encode(without_interval_, without_interval - kLeftOut);
  } else {
    encoder.encode(multiples_, with_interval - kLeftOut);
  }
}

template <bool kHasUnchanged>
void GpsTimeEncoder<kHasUnchanged>::encode(ArithmeticEncoder& encoder, std::uint64_t time) {
  if (kHasUnchanged && time == current().time) return encode_symbol(encoder, 0, 511);
  const auto difference = static_cast<std::int32_t>(time - current().time);
  if (!fits(time, 0)) {
    for (const unsigned step : {1U, 2U, 3U}) {
      if (!fits(time, step)) continue;
      encode_symbol(encoder, 2 + step, 512 + step);
      last_ = (last_ + step) % 4;
      return encode(encoder, time);
    }
    encode_symbol(encoder, 2, 512);
    integers_.encode(encoder, static_cast<std::uint32_t>(current().time >> 32), static_cast<std::uint32_t>(time >> 32),
                     8);
    encoder.encode_bits(static_cast<std::uint32_t>(time), 32);
    newest_ = (newest_ + 1) % 4;
    last_ = newest_;
    current() = {time};
    return;
  }
  if (current().interval == 0) {
    encoder.encode(without_interval_, 1 - kLeftOut);
    integers_.encode(encoder, 0, static_cast<std::uint32_t>(difference), 0);
    current().interval = difference;
    current().num_exceptions = 0;
  } else {
    encode_multiple(encoder, difference);
  }
  current().time = time;
}

template <bool kHasUnchanged>
void GpsTimeEncoder<kHasUnchanged>::encode_multiple(ArithmeticEncoder& encoder, std::int32_t difference) {
  const int multiple = std::clamp(nearest_multiple(difference, current().interval), -10, 500);
  encoder.encode(multiples_, static_cast<unsigned>(multiple >= 0 ? multiple : 500 - multiple));
  const unsigned context = multiple == 1     ? 1
                           : multiple == 0   ? 7
                           : multiple == 500 ? 4
                           : multiple == -10 ? 6
                           : multiple < 0    ? 5
                           : multiple < 10   ? 2
                                             : 3;
  const std::uint32_t predicted = static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(current().interval);
  integers_.encode(encoder, predicted, static_cast<std::uint32_t>(difference), context);
  if (multiple == 1) current().num_exceptions = 0;
  if ((multiple == 0 || multiple == 500 || multiple == -10) && ++current().num_exceptions > 3) {
    current().interval = difference;
    current().num_exceptions = 0;
  }
}

template class GpsTimeEncoder<false>;
template class GpsTimeEncoder<true>;

void GpsTimeEncoder1::encode(ArithmeticEncoder& encoder, std::uint64_t time) {
  const bool fits = fits_in_32_bits(time - time_);
  const auto difference = static_cast<std::int32_t>(time - time_);
  const auto bits = static_cast<std::uint32_t>(difference);
  if (interval_ == 0) {
    encoder.encode(without_interval_, time == time_ ? 0 : fits ? 1 : 2);
    if (time != time_ && fits) {
      integers_.encode(encoder, 0, bits, 0);
      interval_ = difference;
    } else if (!fits) {
      encoder.encode_64_bits(time);
    }
  } else if (time == time_ || !fits) {
    encoder.encode(multiples_, time == time_ ? 511 : 510);
    if (time != time_) encoder.encode_64_bits(time);
  } else {
    const int multiple = std::clamp(nearest_multiple(difference, interval_), 0, 509);
    encoder.encode(multiples_, static_cast<unsigned>(multiple));
    const std::uint32_t predicted = multiple == 0
                                        ? static_cast<std::uint32_t>(interval_ / 4)
                                        : static_cast<std::uint32_t>(multiple) * static_cast<std::uint32_t>(interval_);
    integers_.encode(encoder, predicted, bits,
                     multiple == 1   ? 1
                     : multiple == 0 ? 2
                     : multiple < 10 ? 3
                     : multiple < 50 ? 4
                                     : 5);
    const bool is_exception = multiple == 0 || multiple == 509;
    if (is_exception) ++num_exceptions_;
    if (multiple == 1 || (is_exception && num_exceptions_ > 3)) {
      interval_ = difference;
      num_exceptions_ = 0;
    }
  }
  time_ = time;
}

void ColorEncoder::encode(ArithmeticEncoder& encoder, const laz::Channels& last, const laz::Channels& color) {
  const bool is_colored = color[0] != color[1] || color[0] != color[2];
  const unsigned changes = changed_bytes(last, color) | (is_colored ? 1U << 6 : 0U);
  encoder.encode(changes_, changes);
  const auto difference = [&](unsigned i) { return byte_of(color, i) - byte_of(last, i); };
  const auto encode_byte = [&](unsigned i, int expected) {
    if ((changes >> i & 1) == 0) return;
    encoder.encode(bytes_[i], static_cast<unsigned>(byte_of(color, i) - expected) & 0xff);
  };
  encode_byte(0, byte_of(last, 0));
  encode_byte(1, byte_of(last, 1));
  if (!is_colored) return;
  for (const unsigned half : {0U, 1U}) {
    const int red = difference(half);
    encode_byte(2 + half, std::clamp(byte_of(last, 2 + half) + red, 0, 255));
    const int mean = (red + difference(2 + half)) / 2;
    encode_byte(4 + half, std::clamp(byte_of(last, 4 + half) + mean, 0, 255));
  }
}

void ColorEncoder1::encode(ArithmeticEncoder& encoder, const laz::Channels& last, const laz::Channels& color) {
  const unsigned changes = changed_bytes(last, color);
  encoder.encode(changes_, changes);
  for (unsigned i = 0; i < 6; ++i) {
    if ((changes >> i & 1) == 0) continue;
    bytes_.encode(encoder, static_cast<std::uint32_t>(byte_of(last, i)), static_cast<std::uint32_t>(byte_of(color, i)),
                  i);
  }
}

}  // namespace vdbmap::test
