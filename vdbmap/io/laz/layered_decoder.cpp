// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/layered_decoder.h"

#include <algorithm>
#include <utility>

#include "vdbmap/io/laz/layered_items.h"

namespace vdbmap::laz {
namespace {

std::size_t layered_record_length(const LaszipRecord& laszip) {
  return kLayeredPointSize + (laszip.has_color ? sizeof(Channels) : 0) + (laszip.has_infrared ? 2 : 0) +
         laszip.num_extra_bytes;
}

std::size_t num_layers(const LaszipRecord& laszip) {
  return kNumPointLayers + (laszip.has_color ? 1 : 0) + (laszip.has_infrared ? 1 : 0) + laszip.num_extra_bytes;
}

std::size_t front_size(const LaszipRecord& laszip) {
  return layered_record_length(laszip) + sizeof(std::uint32_t) * (1 + num_layers(laszip));
}

// Takes one layer after the other from a chunk.
class Layers {
 public:
  Layers(const LaszipRecord& laszip, std::string_view chunk)
      : sizes_(chunk.data() + layered_record_length(laszip) + sizeof(std::uint32_t)),
        rest_(chunk.substr(front_size(laszip))) {}

  LayerDecoder next(bool is_wanted) {
    const std::string_view layer = rest_.substr(0, load<std::uint32_t>(sizes_));
    sizes_ += sizeof(std::uint32_t);
    rest_.remove_prefix(layer.size());
    if (!is_wanted || layer.empty()) return {};
    return {true, ArithmeticDecoder(layer)};
  }

 private:
  const char* sizes_;
  std::string_view rest_;
};

}  // namespace

std::optional<LayeredChunkFront> read_layered_chunk_front(const LaszipRecord& laszip, std::string_view bytes) {
  LayeredChunkFront front;
  front.size = front_size(laszip);
  if (bytes.size() < front.size) return std::nullopt;
  const char* number = bytes.data() + layered_record_length(laszip);
  front.num_points = load<std::uint32_t>(number);
  for (std::size_t i = 1; i <= num_layers(laszip); ++i) {
    front.size += load<std::uint32_t>(number + i * sizeof(std::uint32_t));
  }
  return front;
}

struct LayeredDecoder::State {
  State(const LaszipRecord& laszip, std::string_view chunk_bytes, LayerChoice choice)
      : chunk(chunk_bytes),
        version(laszip.version),
        record_length(layered_record_length(laszip)),
        points(load_layered_point(chunk.data())) {
    const bool takes_all = choice == LayerChoice::kAll;
    Layers layers(laszip, chunk);
    for (std::size_t i = 0; i < kNumPointLayers; ++i) {
      point_layers[i] = layers.next(takes_all || (i != kScanAngle && i != kUserData && i != kSource));
    }
    point_layers[kReturnsXy].is_decoded = true;  // no chunk does without it

    const unsigned channel = load_layered_point(chunk.data()).channel;
    const char* item = chunk.data() + kLayeredPointSize;
    if (laszip.has_color) {
      color_layer = layers.next(true);
      colors.emplace(version, channel, item);
      item += sizeof(Channels);
    }
    if (laszip.has_infrared) {
      infrared_layer = layers.next(takes_all);
      infrared.emplace(version, channel, item);
      item += sizeof(std::uint16_t);
    }
    for (std::size_t i = 0; i < laszip.num_extra_bytes; ++i) extra_layers.push_back(layers.next(takes_all));
    extra_bytes.emplace(version, channel, std::string_view(item, laszip.num_extra_bytes));
  }

  template <typename Predicate>
  bool all_of_layers(const Predicate& predicate) const {
    const auto holds = [&](const LayerDecoder& layer) { return !layer.is_decoded || predicate(layer.decoder); };
    return std::ranges::all_of(point_layers, holds) && holds(color_layer) && holds(infrared_layer) &&
           std::ranges::all_of(extra_layers, holds);
  }

  void decode_next(char* record) {
    store_layered_point(record, points.decode(point_layers));
    const unsigned context = points.context(version);
    char* item = record + kLayeredPointSize;
    if (colors) {
      colors->decode(color_layer, context, item);
      item += sizeof(Channels);
    }
    if (infrared) {
      infrared->decode(infrared_layer, context, item);
      item += sizeof(std::uint16_t);
    }
    extra_bytes->decode(extra_layers, context, item);
  }

  std::string_view chunk;
  unsigned version;
  std::size_t record_length;
  bool is_at_first = true;
  std::array<LayerDecoder, kNumPointLayers> point_layers;
  LayerDecoder color_layer;
  LayerDecoder infrared_layer;
  std::vector<LayerDecoder> extra_layers;
  LayeredPointDecoder points;
  std::optional<LayeredColorDecoder> colors;
  std::optional<InfraredDecoder> infrared;
  std::optional<LayeredExtraBytesDecoder> extra_bytes;
};

std::size_t LayeredDecoder::least_size(const LaszipRecord& laszip) { return front_size(laszip); }

LayeredDecoder::LayeredDecoder(const LaszipRecord& laszip, std::string_view chunk, LayerChoice choice)
    : state_(std::make_unique<State>(laszip, chunk, choice)) {}
LayeredDecoder::~LayeredDecoder() = default;
LayeredDecoder::LayeredDecoder(LayeredDecoder&&) noexcept = default;
LayeredDecoder& LayeredDecoder::operator=(LayeredDecoder&&) noexcept = default;

void LayeredDecoder::decode(char* records, std::size_t count) {
  State& state = *state_;
  if (state.is_at_first && count > 0) {
    std::memcpy(records, state.chunk.data(), state.record_length);
    records += state.record_length;
    --count;
    state.is_at_first = false;
  }
  for (; count > 0; --count, records += state.record_length) state.decode_next(records);
}

bool LayeredDecoder::is_beyond_end() const {
  return !state_->all_of_layers([](const ArithmeticDecoder& decoder) { return !decoder.is_beyond_end(); });
}

bool LayeredDecoder::is_at_end() const {
  return state_->all_of_layers([](const ArithmeticDecoder& decoder) { return decoder.is_at_end(); });
}

}  // namespace vdbmap::laz
