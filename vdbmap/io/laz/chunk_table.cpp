// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/chunk_table.h"

#include "vdbmap/io/laz/chunk_list.h"
#include "vdbmap/io/laz/integer_decoder.h"

namespace vdbmap::laz {
namespace {

constexpr std::uint64_t kTableStart = 8;  // [bytes] version, number of chunks

// Where the chunks lie, in front of the table: [bytes].
struct Place {
  std::uint64_t begin = 0;
  std::uint64_t table = 0;

  bool is_possible(const ByteReader& file) const {
    return table >= begin && table <= file.size() && file.size() - table >= kTableStart;
  }
};

// Writers that cannot go back to the front of the points say it in the last 8 bytes of the file.
std::optional<Place> find_table(const ByteReader& file, const LasHeader& header) {
  Place place{header.points_offset + kTableOffsetSize, 0};
  if (place.begin > file.size()) return std::nullopt;
  const auto offset_at = [&](std::uint64_t at) {
    return load<std::uint64_t>(file.bytes_at(at, kTableOffsetSize).data());
  };
  place.table = offset_at(header.points_offset);
  if (!place.is_possible(file)) place.table = offset_at(file.size() - kTableOffsetSize);
  return place.is_possible(file) ? std::optional(place) : std::nullopt;
}

// No chunk takes less than its first point, so that there are no more entries than the chunks' bytes account for.
std::uint64_t least_chunk_size(const LasHeader& header) { return header.record_length; }

}  // namespace

std::optional<ChunkTable> read_chunk_table(const ByteReader& file, const LasHeader& header,
                                           const LaszipRecord& laszip) {
  const std::optional<Place> place = find_table(file, header);
  if (!place) return std::nullopt;
  const std::uint64_t available = place->table - place->begin;
  const std::string_view bytes = file.bytes_at(place->table, file.size() - place->table);
  const auto version = load<std::uint32_t>(bytes.data());
  const auto count = load<std::uint32_t>(bytes.data() + 4);
  if (version != 0 || count > available / least_chunk_size(header)) return std::nullopt;

  ChunkTable table{place->table, {}};
  if (count == 0) return table;
  ArithmeticDecoder decoder(bytes.substr(kTableStart));
  IntegerDecoder<32> integers(2);
  ChunkSize last;
  std::uint64_t num_bytes = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!laszip.has_fixed_chunks) {
      last.num_points = integers.decode(decoder, static_cast<std::uint32_t>(last.num_points), 0);
    }
    last.num_bytes = integers.decode(decoder, static_cast<std::uint32_t>(last.num_bytes), 1);
    num_bytes += last.num_bytes;
    if (num_bytes > available || decoder.is_beyond_end()) return std::nullopt;
    table.chunks.push_back(last);
  }
  return table;
}

}  // namespace vdbmap::laz
