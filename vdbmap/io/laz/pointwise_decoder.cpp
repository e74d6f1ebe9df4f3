// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/pointwise_decoder.h"

#include <optional>
#include <utility>
#include <variant>

#include "vdbmap/io/laz/color_decoder.h"
#include "vdbmap/io/laz/extra_bytes_decoder.h"
#include "vdbmap/io/laz/gps_time_decoder.h"
#include "vdbmap/io/laz/point_decoder.h"

namespace vdbmap::laz {
namespace {

std::size_t record_length_of(const LaszipRecord& laszip) {
  return Point::kSize + (laszip.has_time ? sizeof(std::uint64_t) : 0) + (laszip.has_color ? sizeof(Channels) : 0) +
         laszip.num_extra_bytes;
}

}  // namespace

// All items of one version; each takes the bytes that it stands for from the first point.
template <typename Points, typename Times, typename Colors>
class ItemsDecoder {
 public:
  ItemsDecoder(const LaszipRecord& laszip, const char* first) : points_(load_point(first)) {
    const char* item = first + Point::kSize;
    if (laszip.has_time) {
      times_.emplace(load<std::uint64_t>(item));
      item += sizeof(std::uint64_t);
    }
    if (laszip.has_color) {
      colors_.emplace();
      last_color_ = load_channels(item);
      item += sizeof(Channels);
    }
    extra_bytes_.emplace(std::string_view(item, laszip.num_extra_bytes));
  }

  void decode(ArithmeticDecoder& shared_decoder, char* record, std::size_t record_length, std::size_t count) {
    ArithmeticDecoder decoder = shared_decoder;
    for (std::size_t i = 0; i < count && !decoder.is_beyond_end(); ++i, record += record_length) {
      char* item = record + Point::kSize;
      store_point(record, points_.decode(decoder));
      if (times_) {
        store(item, times_->decode(decoder));
        item += sizeof(std::uint64_t);
      }
      if (colors_) {
        last_color_ = colors_->decode(decoder, last_color_);
        store_channels(item, last_color_);
        item += sizeof(Channels);
      }
      extra_bytes_->decode(decoder, item);
    }
    shared_decoder = decoder;
  }

 private:
  Points points_;
  std::optional<Times> times_;
  std::optional<Colors> colors_;
  Channels last_color_{};
  std::optional<ExtraBytesDecoder> extra_bytes_;
};

using Items1 = ItemsDecoder<PointDecoder1, GpsTimeDecoder1, ColorModels1>;
using Items2 = ItemsDecoder<PointDecoder2, GpsTimeDecoder<true>, ColorModels>;

struct PointwiseDecoder::State {
  State(const LaszipRecord& laszip, std::string_view chunk)
      : bytes(chunk), record_length(record_length_of(laszip)), decoder(chunk.substr(record_length)) {
    if (laszip.version == 1) items.emplace<Items1>(laszip, chunk.data());
    if (laszip.version != 1) items.emplace<Items2>(laszip, chunk.data());
  }

  std::string_view bytes;
  std::size_t record_length;
  bool is_at_first = true;
  ArithmeticDecoder decoder;
  std::variant<std::monostate, Items1, Items2> items;
};

std::size_t PointwiseDecoder::least_size(const LaszipRecord& laszip) { return record_length_of(laszip); }

PointwiseDecoder::PointwiseDecoder(const LaszipRecord& laszip, std::string_view bytes)
    : state_(std::make_unique<State>(laszip, bytes)) {}
PointwiseDecoder::~PointwiseDecoder() = default;
PointwiseDecoder::PointwiseDecoder(PointwiseDecoder&&) noexcept = default;
PointwiseDecoder& PointwiseDecoder::operator=(PointwiseDecoder&&) noexcept = default;

void PointwiseDecoder::decode(char* records, std::size_t count) {
  State& state = *state_;
  if (state.is_at_first && count > 0) {
    std::memcpy(records, state.bytes.data(), state.record_length);
    records += state.record_length;
    --count;
    state.is_at_first = false;
  }
  if (auto* items = std::get_if<Items1>(&state.items))
    items->decode(state.decoder, records, state.record_length, count);
  if (auto* items = std::get_if<Items2>(&state.items))
    items->decode(state.decoder, records, state.record_length, count);
}

bool PointwiseDecoder::is_beyond_end() const { return state_->decoder.is_beyond_end(); }

bool PointwiseDecoder::is_at_end() const { return state_->decoder.is_at_end(); }

std::size_t PointwiseDecoder::num_used() const {
  return static_cast<std::size_t>(state_->decoder.next() - state_->bytes.data());
}

}  // namespace vdbmap::laz
