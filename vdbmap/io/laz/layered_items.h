// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "vdbmap/io/laz/color_decoder.h"
#include "vdbmap/io/laz/layered_point_decoder.h"
#include "vdbmap/io/laz/point_records.h"

namespace vdbmap::laz {

/// The values before of an item that follows the channels of the points. Version 3 looks at those of the channel before
/// where it returns to a channel, as LASzip did when it was written; version 4 does not.
template <typename Value>
class ChannelValues {
 public:
  ChannelValues(unsigned version, unsigned channel, Value first) : keeps_to_channel_(version >= 4), current_(channel) {
    values_[channel] = std::move(first);
    is_used_[channel] = true;
  }

  Value& select(unsigned context) {
    Value* last = &values_[current_];
    if (context == current_) return *last;
    const bool is_new = !is_used_[context];
    if (is_new) values_[context] = *last;
    is_used_[context] = true;
    current_ = context;
    return is_new || keeps_to_channel_ ? values_[context] : *last;
  }

 private:
  bool keeps_to_channel_;
  unsigned current_;
  std::array<Value, kNumChannels> values_{};
  std::array<bool, kNumChannels> is_used_{};
};

template <typename Model>
class ChannelModels {
 public:
  Model& at(unsigned context) {
    if (!models_[context]) models_[context] = std::make_unique<Model>();
    return *models_[context];
  }

 private:
  std::array<std::unique_ptr<Model>, kNumChannels> models_;
};

class LayeredColorDecoder {
 public:
  LayeredColorDecoder(unsigned version, unsigned channel, const char* first)
      : values_(version, channel, load_channels(first)) {}

  void decode(LayerDecoder& layer, unsigned context, char* bytes) {
    Channels& last = values_.select(context);
    if (layer.is_decoded) last = models_.at(context).decode(layer.decoder, last);
    store_channels(bytes, last);
  }

 private:
  ChannelValues<Channels> values_;
  ChannelModels<ColorModels> models_;
};

class InfraredDecoder {
 public:
  InfraredDecoder(unsigned version, unsigned channel, const char* first)
      : values_(version, channel, load<std::uint16_t>(first)) {}

  void decode(LayerDecoder& layer, unsigned context, char* bytes) {
    std::uint16_t& last = values_.select(context);
    if (layer.is_decoded) {
      Models& models = models_.at(context);
      const unsigned changes = layer.decoder.decode(models.changes);
      unsigned low = last & 0xffU;
      unsigned high = last >> 8U;
      if (changes & 1) low += layer.decoder.decode(models.low);
      if (changes & 2) high += layer.decoder.decode(models.high);
      last = static_cast<std::uint16_t>((low & 0xff) | (high & 0xff) << 8);
    }
    store(bytes, last);
  }

 private:
  struct Models {
    SymbolModel<4> changes;
    SymbolModel<256> low;
    SymbolModel<256> high;
  };

  ChannelValues<std::uint16_t> values_;
  ChannelModels<Models> models_;
};

class LayeredExtraBytesDecoder {
 public:
  LayeredExtraBytesDecoder(unsigned version, unsigned channel, std::string_view first)
      : values_(version, channel, std::vector<char>(first.begin(), first.end())) {}

  void decode(std::vector<LayerDecoder>& layers, unsigned context, char* bytes) {
    std::vector<char>& last = values_.select(context);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      LayerDecoder& layer = layers[i];
      if (layer.is_decoded) {
        auto& models = models_.at(context);
        models.resize(layers.size());
        last[i] = static_cast<char>(static_cast<unsigned char>(last[i]) + layer.decoder.decode(models[i]));
      }
      bytes[i] = last[i];
    }
  }

 private:
  ChannelValues<std::vector<char>> values_;
  ChannelModels<std::vector<SymbolModel<256>>> models_;
};

}  // namespace vdbmap::laz
