// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "vdbmap/io/laz/gps_time_decoder.h"
#include "vdbmap/io/laz/integer_decoder.h"
#include "vdbmap/io/laz/point_records.h"
#include "vdbmap/io/laz/return_contexts.h"
#include "vdbmap/io/laz/running_median.h"

namespace vdbmap::laz {

inline constexpr std::size_t kLayeredPointSize = 30;  // [bytes]
inline constexpr unsigned kNumChannels = 4;           // scanners in one file, each with statistics of its own

/// Layers in their order in the file; each extra byte has another one behind them.
enum Layer : std::size_t {
  kReturnsXy,
  kZ,
  kClassification,
  kFlags,
  kIntensity,
  kScanAngle,
  kUserData,
  kSource,
  kGpsTime,
  kNumPointLayers
};

/// The part that all of the formats have (LAS 1.4-R15, table 13).
struct LayeredPoint {
  std::uint32_t x = 0;  // so that sums of damaged differences may overflow
  std::uint32_t y = 0;
  std::uint32_t z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t number = 0;  // of the return, 4 bits
  std::uint8_t num_returns = 0;
  std::uint8_t flags = 0;  // 4 of the class, scan direction, edge
  std::uint8_t channel = 0;
  std::uint8_t classification = 0;
  std::uint8_t user_data = 0;
  std::uint16_t scan_angle = 0;
  std::uint16_t source = 0;
  std::uint64_t time = 0;  // bits of a double

  bool is_first() const { return number == 1; }
  bool is_last() const { return number >= num_returns; }
  unsigned return_kind() const { return (is_first() ? 1 : 0) + (is_last() ? 2 : 0); }
};

inline LayeredPoint load_layered_point(const char* record) {
  const auto returns = load<std::uint8_t>(record + 14);
  const auto flags = load<std::uint8_t>(record + 15);
  LayeredPoint point;
  point.x = load<std::uint32_t>(record);
  point.y = load<std::uint32_t>(record + 4);
  point.z = load<std::uint32_t>(record + 8);
  point.intensity = load<std::uint16_t>(record + 12);
  point.number = returns & 15;
  point.num_returns = returns >> 4;
  point.flags = static_cast<std::uint8_t>((flags & 15) | (flags >> 6 & 3) << 4);
  point.channel = flags >> 4 & 3;
  point.classification = load<std::uint8_t>(record + 16);
  point.user_data = load<std::uint8_t>(record + 17);
  point.scan_angle = load<std::uint16_t>(record + 18);
  point.source = load<std::uint16_t>(record + 20);
  point.time = load<std::uint64_t>(record + 22);
  return point;
}

inline void store_layered_point(char* record, const LayeredPoint& point) {
  store(record, point.x);
  store(record + 4, point.y);
  store(record + 8, point.z);
  store(record + 12, point.intensity);
  store(record + 14, static_cast<std::uint8_t>(point.number | point.num_returns << 4));
  store(record + 15, static_cast<std::uint8_t>((point.flags & 15) | point.channel << 4 | (point.flags >> 4 & 3) << 6));
  store(record + 16, point.classification);
  store(record + 17, point.user_data);
  store(record + 18, point.scan_angle);
  store(record + 20, point.source);
  store(record + 22, point.time);
}

/// A code that may be missing: nothing changes in an attribute then.
struct LayerDecoder {
  bool is_decoded = false;
  ArithmeticDecoder decoder;
};

/// The point before of one scanner channel, and the statistics of its points.
struct Channel {
  explicit Channel(const LayeredPoint& before) : last(before), times(before.time) {
    heights.fill(before.z);
    intensities.fill(before.intensity);
  }

  LayeredPoint last;
  bool has_new_time = false;  // the last one, compared with the one before

  std::array<RunningMedian, 12> x_steps;  // by context of the return, and whether the time is new
  std::array<RunningMedian, 12> y_steps;
  std::array<std::uint32_t, 8> heights;
  std::array<std::uint16_t, 8> intensities;

  ModelSet<8, 128> changes;
  SymbolModel<3> next_channel;
  ModelSet<16, 16> num_returns;
  ModelSet<16, 16> numbers;
  SymbolModel<13> number_steps;
  IntegerDecoder<32> x{2};
  IntegerDecoder<32> y{22};
  IntegerDecoder<32> z{20};
  ModelSet<64, 256> classifications;
  ModelSet<64, 64> flags;
  IntegerDecoder<16> intensity_decoder{4};
  IntegerDecoder<16> scan_angles{2};
  ModelSet<64, 256> user_data;
  IntegerDecoder<16> sources;
  GpsTimeDecoder<false> times;
};

/// Bits of the symbol that says what changes in a point; the lowest two: how its return number does.
enum Change : unsigned {
  kNumReturnsChange = 4,
  kScanAngleChange = 8,
  kTimeChange = 16,
  kSourceChange = 32,
  kChannelChange = 64
};

class LayeredPointDecoder {
 public:
  explicit LayeredPointDecoder(const LayeredPoint& first) : current_(first.channel) {
    channels_[current_] = std::make_unique<Channel>(first);
  }

  const LayeredPoint& decode(std::array<LayerDecoder, kNumPointLayers>& layers) {
    ArithmeticDecoder& decoder = layers[kReturnsXy].decoder;
    const unsigned changes = decode_changes(decoder);
    Channel& channel = *channels_[current_];
    channel.has_new_time = (changes & kTimeChange) != 0;
    decode_returns(decoder, channel, changes);
    decode_xy(decoder, channel);
    decode_attributes(layers, channel, changes);
    return channel.last;
  }

  /// Whose context other items use. Version 3 tells them the channel where it changes, and 0 where it does not.
  unsigned context(unsigned version) const { return version >= 4 || has_switched_ ? current_ : 0; }

 private:
  unsigned decode_changes(ArithmeticDecoder& decoder) {
    Channel& before = *channels_[current_];
    const unsigned kind = before.last.return_kind() + (before.has_new_time ? 4 : 0);
    const unsigned changes = decoder.decode(before.changes.at(kind));
    has_switched_ = (changes & kChannelChange) != 0;
    if (!has_switched_) return changes;
    current_ = (current_ + decoder.decode(before.next_channel) + 1) % kNumChannels;
    if (!channels_[current_]) channels_[current_] = std::make_unique<Channel>(before.last);
    channels_[current_]->last.channel = static_cast<std::uint8_t>(current_);
    return changes;
  }

  static void decode_returns(ArithmeticDecoder& decoder, Channel& channel, unsigned changes) {
    LayeredPoint& point = channel.last;
    if (changes & kNumReturnsChange) {
      point.num_returns = static_cast<std::uint8_t>(decoder.decode(channel.num_returns.at(point.num_returns)));
    }
    const unsigned last = point.number;
    const auto next_number = [&]() -> unsigned {
      switch (changes & 3) {
        case 0:
          return last;
        case 1:
          return last + 1;
        case 2:
          return last + 15;
        default:
          return channel.has_new_time ? decoder.decode(channel.numbers.at(last))
                                      : last + decoder.decode(channel.number_steps) + 2;
      }
    };
    point.number = next_number() & 15;
  }

  static void decode_xy(ArithmeticDecoder& decoder, Channel& channel) {
    LayeredPoint& point = channel.last;
    const bool is_only = point.num_returns == 1;
    const unsigned context = 2U * kReturnContexts6[point.num_returns][point.number] + (channel.has_new_time ? 1 : 0);
    RunningMedian& x_step = channel.x_steps[context];
    RunningMedian& y_step = channel.y_steps[context];
    const std::uint32_t dx = channel.x.decode(decoder, static_cast<std::uint32_t>(x_step.value()), is_only ? 1 : 0);
    const std::uint32_t dy = channel.y.decode(decoder, static_cast<std::uint32_t>(y_step.value()),
                                              length_context(channel.x.length(), 20, is_only));
    x_step.add(static_cast<std::int32_t>(dx));
    y_step.add(static_cast<std::int32_t>(dy));
    point.x += dx;
    point.y += dy;
  }

  static void decode_attributes(std::array<LayerDecoder, kNumPointLayers>& layers, Channel& channel, unsigned changes) {
    LayeredPoint& point = channel.last;
    const bool is_only = point.num_returns == 1;
    const unsigned kind = point.return_kind();
    const unsigned new_time = channel.has_new_time ? 1 : 0;
    if (LayerDecoder& layer = layers[kZ]; layer.is_decoded) {
      const unsigned length = (channel.x.length() + channel.y.length()) / 2;
      std::uint32_t& height = channel.heights[return_level(point.num_returns, point.number)];
      height = channel.z.decode(layer.decoder, height, length_context(length, 18, is_only));
      point.z = height;
    }
    if (LayerDecoder& layer = layers[kClassification]; layer.is_decoded) {
      const unsigned context = (point.classification & 31U) * 2 + (kind == 3 ? 1 : 0);
      point.classification = static_cast<std::uint8_t>(layer.decoder.decode(channel.classifications.at(context)));
    }
    if (LayerDecoder& layer = layers[kFlags]; layer.is_decoded) {
      point.flags = static_cast<std::uint8_t>(layer.decoder.decode(channel.flags.at(point.flags)));
    }
    if (LayerDecoder& layer = layers[kIntensity]; layer.is_decoded) {
      std::uint16_t& intensity = channel.intensities[2 * kind + new_time];
      intensity = static_cast<std::uint16_t>(channel.intensity_decoder.decode(layer.decoder, intensity, kind));
      point.intensity = intensity;
    }
    if (LayerDecoder& layer = layers[kScanAngle]; layer.is_decoded && (changes & kScanAngleChange)) {
      point.scan_angle =
          static_cast<std::uint16_t>(channel.scan_angles.decode(layer.decoder, point.scan_angle, new_time));
    }
    if (LayerDecoder& layer = layers[kUserData]; layer.is_decoded) {
      point.user_data = static_cast<std::uint8_t>(layer.decoder.decode(channel.user_data.at(point.user_data / 4)));
    }
    if (LayerDecoder& layer = layers[kSource]; layer.is_decoded && (changes & kSourceChange)) {
      point.source = static_cast<std::uint16_t>(channel.sources.decode(layer.decoder, point.source));
    }
    if (LayerDecoder& layer = layers[kGpsTime]; layer.is_decoded && (changes & kTimeChange)) {
      point.time = channel.times.decode(layer.decoder);
    }
  }

  std::array<std::unique_ptr<Channel>, kNumChannels> channels_;
  unsigned current_;
  bool has_switched_ = false;
};

}  // namespace vdbmap::laz
