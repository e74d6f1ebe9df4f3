// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/laz_points.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "tests/support/laz_items.h"
#include "vdbmap/io/laz/layered_point_decoder.h"
#include "vdbmap/io/laz/point_decoder.h"

namespace vdbmap::test {
namespace {

using laz::kReturnContexts16;
using laz::kReturnContexts6;
using laz::length_context;
using laz::return_level;

std::uint32_t bits_of(std::int32_t number) { return static_cast<std::uint32_t>(number); }

// Bytes by the byte before.
class ByteChainEncoder {
 public:
  void encode(ArithmeticEncoder& encoder, std::uint8_t last, std::uint8_t byte) {
    encoder.encode(models_.at(last), byte);
  }

 private:
  laz::ModelSet<256, 256> models_;
};

class PointEncoder2 {
 public:
  explicit PointEncoder2(const laz::Point& first) : last_(first) {}

  void encode(ArithmeticEncoder& encoder, const laz::Point& point) {
    const unsigned n = point.num_returns();
    const unsigned context = kReturnContexts16[n][point.number()];
    const unsigned level = return_level(n, point.number());
    std::uint16_t& last_intensity = last_intensities_[context];
    const bool has_new_intensity = last_intensity != point.intensity;
    const unsigned changes = (last_.returns != point.returns ? 32U : 0U) | (has_new_intensity ? 16U : 0U) |
                             (last_.classification != point.classification ? 8U : 0U) |
                             (last_.scan_angle != point.scan_angle ? 4U : 0U) |
                             (last_.user_data != point.user_data ? 2U : 0U) | (last_.source != point.source ? 1U : 0U);
    encoder.encode(changes_, changes);
    if (changes & 32) returns_.encode(encoder, last_.returns, point.returns);
    if (changes & 16) intensities_.encode(encoder, last_intensity, point.intensity, std::min(context, 3U));
    last_intensity = point.intensity;
    if (changes & 8) classifications_.encode(encoder, last_.classification, point.classification);
    if (changes & 4) {
      encoder.encode(scan_angles_[point.scan_direction()],
                     static_cast<std::uint8_t>(point.scan_angle - last_.scan_angle));
    }
    if (changes & 2) user_data_.encode(encoder, last_.user_data, point.user_data);
    if (changes & 1) sources_.encode(encoder, last_.source, point.source);

    const std::uint32_t dx = point.x - last_.x;
    const std::uint32_t dy = point.y - last_.y;
    x_.encode(encoder, bits_of(x_steps_[context].value()), dx, n == 1 ? 1 : 0);
    y_.encode(encoder, bits_of(y_steps_[context].value()), dy, length_context(x_.length(), 20, n == 1));
    x_steps_[context].add(static_cast<std::int32_t>(dx));
    y_steps_[context].add(static_cast<std::int32_t>(dy));
    z_.encode(encoder, last_heights_[level], point.z, length_context((x_.length() + y_.length()) / 2, 18, n == 1));
    last_heights_[level] = point.z;
    last_ = point;
  }

 private:
  laz::Point last_;
  std::array<laz::RunningMedian, 16> x_steps_;
  std::array<laz::RunningMedian, 16> y_steps_;
  std::array<std::uint32_t, 8> last_heights_{};
  std::array<std::uint16_t, 16> last_intensities_{};
  laz::SymbolModel<64> changes_;
  IntegerEncoder<32> x_{2};
  IntegerEncoder<32> y_{22};
  IntegerEncoder<32> z_{20};
  IntegerEncoder<16> intensities_{4};
  IntegerEncoder<16> sources_;
  std::array<laz::SymbolModel<256>, 2> scan_angles_;
  ByteChainEncoder returns_;
  ByteChainEncoder classifications_;
  ByteChainEncoder user_data_;
};

class PointEncoder1 {
 public:
  explicit PointEncoder1(const laz::Point& first) : last_(first) {}

  void encode(ArithmeticEncoder& encoder, const laz::Point& point) {
    const std::uint32_t dx = point.x - last_.x;
    const std::uint32_t dy = point.y - last_.y;
    x_.encode(encoder, median(x_steps_), dx);
    y_.encode(encoder, median(y_steps_), dy, std::min(x_.length(), 19U));
    const unsigned length = (x_.length() + y_.length()) / 2;
    z_.encode(encoder, last_.z, point.z, std::min(length, 19U));
    x_steps_ = {x_steps_[1], x_steps_[2], dx};
    y_steps_ = {y_steps_[1], y_steps_[2], dy};

    const unsigned changes =
        (last_.intensity != point.intensity ? 32U : 0U) | (last_.returns != point.returns ? 16U : 0U) |
        (last_.classification != point.classification ? 8U : 0U) | (last_.scan_angle != point.scan_angle ? 4U : 0U) |
        (last_.user_data != point.user_data ? 2U : 0U) | (last_.source != point.source ? 1U : 0U);
    encoder.encode(changes_, changes);
    if (changes & 32) intensities_.encode(encoder, last_.intensity, point.intensity);
    if (changes & 16) returns_.encode(encoder, last_.returns, point.returns);
    if (changes & 8) classifications_.encode(encoder, last_.classification, point.classification);
    if (changes & 4) scan_angles_.encode(encoder, last_.scan_angle, point.scan_angle, length < 3 ? 1 : 0);
    if (changes & 2) user_data_.encode(encoder, last_.user_data, point.user_data);
    if (changes & 1) sources_.encode(encoder, last_.source, point.source);
    last_ = point;
  }

 private:
  static std::uint32_t median(std::array<std::uint32_t, 3> steps) {
    std::ranges::sort(steps, {}, [](std::uint32_t step) { return static_cast<std::int32_t>(step); });
    return steps[1];
  }

  laz::Point last_;
  std::array<std::uint32_t, 3> x_steps_{};
  std::array<std::uint32_t, 3> y_steps_{};
  laz::SymbolModel<64> changes_;
  IntegerEncoder<32> x_;
  IntegerEncoder<32> y_{20};
  IntegerEncoder<32> z_{20};
  IntegerEncoder<16> intensities_;
  IntegerEncoder<8> scan_angles_{2};
  IntegerEncoder<16> sources_;
  ByteChainEncoder returns_;
  ByteChainEncoder classifications_;
  ByteChainEncoder user_data_;
};

template <typename Points, typename Times, typename Colors>
std::string compress_pointwise(const LazItems& items, std::string_view records) {
  const std::size_t length = items.record_length();
  const std::size_t color_at = items.has_time() ? 28 : 20;
  const std::size_t extra_at = length - items.num_extra_bytes;
  const char* last = records.data();
  Points points(laz::load_point(last));
  Times times(items.has_time() ? load<std::uint64_t>(last + 20) : 0);
  Colors colors;
  std::vector<laz::SymbolModel<256>> extra(items.num_extra_bytes);
  ArithmeticEncoder encoder;
  for (const char* record = last + length; record != records.data() + records.size(); record += length) {
    points.encode(encoder, laz::load_point(record));
    if (items.has_time()) times.encode(encoder, load<std::uint64_t>(record + 20));
    if (items.has_color()) {
      colors.encode(encoder, laz::load_channels(last + color_at), laz::load_channels(record + color_at));
    }
    for (std::size_t i = 0; i < extra.size(); ++i) {
      encoder.encode(extra[i], static_cast<std::uint8_t>(record[extra_at + i] - last[extra_at + i]));
    }
    last = record;
  }
  return std::string(records.substr(0, length)) + encoder.finish();
}

// A code that is left out of the file where its attribute never changes.
struct LayerEncoder {
  ArithmeticEncoder encoder;
  bool is_needed = false;

  std::string finish() { return is_needed ? encoder.finish() : std::string(); }
};

struct ChannelEncoder {
  explicit ChannelEncoder(const laz::LayeredPoint& before) : last(before), times(before.time) {
    heights.fill(before.z);
    intensities.fill(before.intensity);
  }

  laz::LayeredPoint last;
  bool has_new_time = false;
  std::array<laz::RunningMedian, 12> x_steps;
  std::array<laz::RunningMedian, 12> y_steps;
  std::array<std::uint32_t, 8> heights;
  std::array<std::uint16_t, 8> intensities;
  laz::ModelSet<8, 128> changes;
  laz::SymbolModel<3> next_channel;
  laz::ModelSet<16, 16> num_returns;
  laz::ModelSet<16, 16> numbers;
  laz::SymbolModel<13> number_steps;
  IntegerEncoder<32> x{2};
  IntegerEncoder<32> y{22};
  IntegerEncoder<32> z{20};
  laz::ModelSet<64, 256> classifications;
  laz::ModelSet<64, 64> flags;
  IntegerEncoder<16> intensity_encoder{4};
  IntegerEncoder<16> scan_angles{2};
  laz::ModelSet<64, 256> user_data;
  IntegerEncoder<16> sources;
  GpsTimeEncoder<false> times;
};

class LayeredPointEncoder {
 public:
  explicit LayeredPointEncoder(const laz::LayeredPoint& first) : current_(first.channel) {
    channels_[current_] = std::make_unique<ChannelEncoder>(first);
    layers_[laz::kReturnsXy].is_needed = layers_[laz::kZ].is_needed = true;
  }

  // Returns the context of the other items.
  unsigned encode(const laz::LayeredPoint& point, unsigned version) {
    ChannelEncoder& before = *channels_[current_];
    const bool switches = point.channel != current_;
    const laz::LayeredPoint& compared = channels_[point.channel] ? channels_[point.channel]->last : before.last;
    const unsigned changes =
        (switches ? 64U : 0U) | (point.source != compared.source ? 32U : 0U) |
        (point.time != compared.time ? 16U : 0U) | (point.scan_angle != compared.scan_angle ? 8U : 0U) |
        (point.num_returns != compared.num_returns ? 4U : 0U) | number_change(compared.number, point.number);
    ArithmeticEncoder& encoder = layers_[laz::kReturnsXy].encoder;
    encoder.encode(before.changes.at(before.last.return_kind() + (before.has_new_time ? 4 : 0)), changes);
    if (switches) {
      encoder.encode(before.next_channel, (point.channel + 3U - current_) % 4);
      if (!channels_[point.channel]) channels_[point.channel] = std::make_unique<ChannelEncoder>(before.last);
      current_ = point.channel;
    }
    ChannelEncoder& channel = *channels_[current_];
    channel.has_new_time = (changes & 16) != 0;
    encode_returns_xy(encoder, channel, point, changes);
    encode_attributes(channel, point, changes);
    channel.last = point;
    return version >= 4 || switches ? current_ : 0;
  }

  std::vector<std::string> finish() {
    std::vector<std::string> codes;
    for (LayerEncoder& layer : layers_) codes.push_back(layer.finish());
    return codes;
  }

 private:
  static unsigned number_change(unsigned last, unsigned number) {
    if (number == last) return 0;
    return number == (last + 1) % 16 ? 1 : number == (last + 15) % 16 ? 2 : 3;
  }

  static void encode_returns_xy(ArithmeticEncoder& encoder, ChannelEncoder& channel, const laz::LayeredPoint& point,
                                unsigned changes) {
    if (changes & 4) encoder.encode(channel.num_returns.at(channel.last.num_returns), point.num_returns);
    if ((changes & 3) == 3 && channel.has_new_time)
      encoder.encode(channel.numbers.at(channel.last.number), point.number);
    if ((changes & 3) == 3 && !channel.has_new_time) {
      encoder.encode(channel.number_steps, (point.number + 14U - channel.last.number) % 16);
    }
    const bool is_only = point.num_returns == 1;
    const unsigned context = 2U * kReturnContexts6[point.num_returns][point.number] + (channel.has_new_time ? 1 : 0);
    const std::uint32_t dx = point.x - channel.last.x;
    const std::uint32_t dy = point.y - channel.last.y;
    channel.x.encode(encoder, bits_of(channel.x_steps[context].value()), dx, is_only ? 1 : 0);
    channel.y.encode(encoder, bits_of(channel.y_steps[context].value()), dy,
                     length_context(channel.x.length(), 20, is_only));
    channel.x_steps[context].add(static_cast<std::int32_t>(dx));
    channel.y_steps[context].add(static_cast<std::int32_t>(dy));
  }

  void encode_attributes(ChannelEncoder& channel, const laz::LayeredPoint& point, unsigned changes) {
    const laz::LayeredPoint& last = channel.last;
    const unsigned kind = point.return_kind();
    const unsigned new_time = channel.has_new_time ? 1 : 0;
    const unsigned length = (channel.x.length() + channel.y.length()) / 2;
    std::uint32_t& height = channel.heights[return_level(point.num_returns, point.number)];
    channel.z.encode(layers_[laz::kZ].encoder, height, point.z, length_context(length, 18, point.num_returns == 1));
    height = point.z;

    encode_symbol(laz::kClassification,
                  channel.classifications.at((last.classification & 31U) * 2 + (kind == 3 ? 1 : 0)),
                  last.classification, point.classification);
    encode_symbol(laz::kFlags, channel.flags.at(last.flags), last.flags, point.flags);
    std::uint16_t& intensity = channel.intensities[2 * kind + new_time];
    if (last.intensity != point.intensity) layers_[laz::kIntensity].is_needed = true;
    channel.intensity_encoder.encode(layers_[laz::kIntensity].encoder, intensity, point.intensity, kind);
    intensity = point.intensity;
    if (changes & 8) {
      layers_[laz::kScanAngle].is_needed = true;
      channel.scan_angles.encode(layers_[laz::kScanAngle].encoder, last.scan_angle, point.scan_angle, new_time);
    }
    encode_symbol(laz::kUserData, channel.user_data.at(last.user_data / 4), last.user_data, point.user_data);
    if (changes & 32) {
      layers_[laz::kSource].is_needed = true;
      channel.sources.encode(layers_[laz::kSource].encoder, last.source, point.source);
    }
    if (changes & 16) {
      layers_[laz::kGpsTime].is_needed = true;
      channel.times.encode(layers_[laz::kGpsTime].encoder, point.time);
    }
  }

  template <unsigned kCapacity>
  void encode_symbol(laz::Layer layer, laz::SymbolModel<kCapacity>& model, unsigned last, unsigned symbol) {
    if (symbol != last) layers_[layer].is_needed = true;
    layers_[layer].encoder.encode(model, symbol);
  }

  std::array<std::unique_ptr<ChannelEncoder>, 4> channels_;
  std::array<LayerEncoder, laz::kNumPointLayers> layers_;
  unsigned current_;
};

// The values before of the other items: of the channel before where version 3 returns to a channel.
class ItemValues {
 public:
  ItemValues(unsigned version, unsigned channel, std::string first) : version_(version), current_(channel) {
    values_[channel] = std::move(first);
  }

  std::string& select(unsigned context) {
    std::string& before = values_[current_];
    if (context == current_) return before;
    const bool is_new = values_.count(context) == 0;
    if (is_new) values_[context] = before;
    current_ = context;
    return is_new || version_ >= 4 ? values_[context] : before;
  }

 private:
  unsigned version_;
  unsigned current_;
  std::map<unsigned, std::string> values_;
};

struct InfraredModels {
  laz::SymbolModel<4> changes;
  std::array<laz::SymbolModel<256>, 2> bytes;
};

std::string compress_layered(const LazItems& items, std::string_view records) {
  const std::size_t length = items.record_length();
  const std::size_t num_color = items.has_color() ? 6 : 0;
  const std::size_t num_infrared = items.has_infrared() ? 2 : 0;
  const char* first = records.data();
  const laz::LayeredPoint first_point = laz::load_layered_point(first);
  LayeredPointEncoder points(first_point);
  const auto values_of = [&](std::size_t at, std::size_t size) {
    return ItemValues(items.version, first_point.channel, std::string(first + at, size));
  };
  ItemValues last_colors = values_of(30, num_color);
  ItemValues last_infrareds = values_of(30 + num_color, num_infrared);
  ItemValues last_extra = values_of(30 + num_color + num_infrared, items.num_extra_bytes);
  std::map<unsigned, ColorEncoder> colors;
  std::map<unsigned, InfraredModels> infrareds;
  std::map<unsigned, std::vector<laz::SymbolModel<256>>> extra;
  LayerEncoder color_layer;
  LayerEncoder infrared_layer;
  std::vector<LayerEncoder> extra_layers(items.num_extra_bytes);

  for (const char* record = first + length; record != first + records.size(); record += length) {
    const unsigned context = points.encode(laz::load_layered_point(record), items.version);
    const char* item = record + 30;
    if (items.has_color()) {
      std::string& last = last_colors.select(context);
      if (last != std::string_view(item, 6)) color_layer.is_needed = true;
      colors[context].encode(color_layer.encoder, laz::load_channels(last.data()), laz::load_channels(item));
      last.assign(item, 6);
      item += 6;
    }
    if (items.has_infrared()) {
      std::string& last = last_infrareds.select(context);
      const unsigned changes = (item[0] != last[0] ? 1U : 0U) | (item[1] != last[1] ? 2U : 0U);
      infrared_layer.encoder.encode(infrareds[context].changes, changes);
      for (std::size_t i = 0; i < 2; ++i) {
        if (item[i] == last[i]) continue;
        infrared_layer.is_needed = true;
        infrared_layer.encoder.encode(infrareds[context].bytes[i], static_cast<std::uint8_t>(item[i] - last[i]));
      }
      last.assign(item, 2);
      item += 2;
    }
    std::string& last = last_extra.select(context);
    extra[context].resize(items.num_extra_bytes);
    for (std::size_t i = 0; i < items.num_extra_bytes; ++i) {
      if (item[i] != last[i]) extra_layers[i].is_needed = true;
      extra_layers[i].encoder.encode(extra[context][i], static_cast<std::uint8_t>(item[i] - last[i]));
      last[i] = item[i];
    }
  }

  std::vector<std::string> codes = points.finish();
  if (items.has_color()) codes.push_back(color_layer.finish());
  if (items.has_infrared()) codes.push_back(infrared_layer.finish());
  for (LayerEncoder& layer : extra_layers) codes.push_back(layer.finish());
  std::string chunk(first, length);
  const auto put_number = [&chunk](std::size_t number) {
    for (int i = 0; i < 4; ++i) chunk += static_cast<char>(number >> 8 * i & 0xff);
  };
  put_number(records.size() / length);
  for (const std::string& code : codes) put_number(code.size());
  for (const std::string& code : codes) chunk += code;
  return chunk;
}

}  // namespace

std::size_t LazItems::record_length() const {
  return (is_layered() ? 30U : 20U) + (has_time() ? 8U : 0U) + (has_color() ? 6U : 0U) + (has_infrared() ? 2U : 0U) +
         num_extra_bytes;
}

std::string compress_chunk(const LazItems& items, std::string_view records) {
  if (items.is_layered()) return compress_layered(items, records);
  if (items.version == 1) return compress_pointwise<PointEncoder1, GpsTimeEncoder1, ColorEncoder1>(items, records);
  return compress_pointwise<PointEncoder2, GpsTimeEncoder<true>, ColorEncoder>(items, records);
}

}  // namespace vdbmap::test
