// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/chunk_decoder.h"

namespace vdbmap::laz {
namespace {

std::variant<PointwiseDecoder, LayeredDecoder> make_decoder(const LaszipRecord& laszip, std::string_view bytes,
                                                            LayerChoice choice) {
  if (laszip.is_layered) return LayeredDecoder(laszip, bytes, choice);
  return PointwiseDecoder(laszip, bytes);
}

}  // namespace

std::size_t ChunkDecoder::least_size(const LaszipRecord& laszip) {
  return laszip.is_layered ? LayeredDecoder::least_size(laszip) : PointwiseDecoder::least_size(laszip);
}

ChunkDecoder::ChunkDecoder(const LaszipRecord& laszip, std::string_view bytes, LayerChoice choice)
    : decoder_(make_decoder(laszip, bytes, choice)) {}

void ChunkDecoder::decode(char* records, std::size_t count) {
  std::visit([&](auto& decoder) { decoder.decode(records, count); }, decoder_);
}

bool ChunkDecoder::is_beyond_end() const {
  return std::visit([](const auto& decoder) { return decoder.is_beyond_end(); }, decoder_);
}

bool ChunkDecoder::is_at_end() const {
  return std::visit([](const auto& decoder) { return decoder.is_at_end(); }, decoder_);
}

}  // namespace vdbmap::laz
