// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/chunk_list.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "vdbmap/io/las/las_point_count.h"
#include "vdbmap/io/laz/chunk_decoder.h"
#include "vdbmap/io/laz/chunk_table.h"

namespace vdbmap::laz {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// What lies in the file, before the header's number of points is compared with it.
struct FoundChunks {
  std::vector<Chunk> chunks;  // the last one of as many points as it may have at most
  std::uint64_t least = 0;    // points in all of them
  std::uint64_t most = 0;
  std::vector<ReadFinding> findings;
};

std::uint64_t end_of_points(const ByteReader& file, const LasRecords& records) {
  return records.extended_begin.value_or(file.size());
}

std::string_view bytes_between(const ByteReader& file, std::uint64_t begin, std::uint64_t end) {
  return file.bytes_at(begin, end - begin);
}

// The header's number, where one of the two may be it.
std::uint64_t highest_number(const LasHeader& header) {
  std::uint64_t highest = 0;
  for (const std::uint64_t number : {header.num_points, header.legacy_num_points}) {
    if (number != kUnknownLasCount) highest = std::max(highest, number);
  }
  return highest == 0 ? kUnlimited : highest;
}

// Of a whole chunk. The last of chunks of one size alone does not say, unless it is layered.
std::optional<std::uint64_t> number_in_last_chunk(const ByteReader& file, const Chunk& chunk,
                                                  const LaszipRecord& laszip) {
  if (!laszip.has_fixed_chunks) return chunk.num_points;
  if (!laszip.is_layered) return std::nullopt;
  const auto front = read_layered_chunk_front(laszip, bytes_between(file, chunk.begin, chunk.end));
  if (!front || front->size != chunk.end - chunk.begin || front->num_points > laszip.points_per_chunk) {
    return std::nullopt;
  }
  return front->num_points;
}

FoundChunks chunks_of_table(const ByteReader& file, const LasHeader& header, const LaszipRecord& laszip,
                            const ChunkTable& table) {
  FoundChunks found;
  std::uint64_t at = header.points_offset + kTableOffsetSize;
  for (const ChunkSize& entry : table.chunks) {
    const std::uint64_t num_points = laszip.has_fixed_chunks ? laszip.points_per_chunk : entry.num_points;
    found.chunks.push_back({at, at + entry.num_bytes, num_points});
    found.most += num_points;
    at += entry.num_bytes;
  }
  if (found.chunks.empty()) return found;
  Chunk& last = found.chunks.back();
  const std::optional<std::uint64_t> number = number_in_last_chunk(file, last, laszip);
  found.least = found.most - last.num_points + number.value_or(1);
  if (number) {
    found.most = found.least;
    last.num_points = *number;
  }
  return found;
}

// The next chunk of known size, which is layered. Nothing where none is whole.
std::optional<Chunk> next_layered_chunk(const ByteReader& file, std::uint64_t at, std::uint64_t end,
                                        const LaszipRecord& laszip) {
  const auto front = read_layered_chunk_front(laszip, bytes_between(file, at, end));
  const bool is_whole = front && front->size <= end - at && front->num_points > 0 &&
                        front->num_points <= laszip.points_per_chunk &&
                        front->num_points / kMostPointsPerByte <= front->size;
  return is_whole ? std::optional(Chunk{at, at + front->size, front->num_points}) : std::nullopt;
}

// The next chunk of `num_points`, whose end nothing tells but its decoding.
std::optional<Chunk> next_pointwise_chunk(const ByteReader& file, std::uint64_t at, std::uint64_t end,
                                          std::uint64_t num_points, const LasHeader& header,
                                          const LaszipRecord& laszip) {
  const std::string_view bytes = bytes_between(file, at, end);
  if (bytes.size() < PointwiseDecoder::least_size(laszip) || num_points / kMostPointsPerByte > bytes.size()) {
    return std::nullopt;
  }
  PointwiseDecoder decoder(laszip, bytes);
  std::string record(header.record_length, '\0');
  for (std::uint64_t i = 0; i < num_points && !decoder.is_beyond_end(); ++i) decoder.decode(record.data(), 1);
  if (decoder.is_beyond_end()) return std::nullopt;
  return Chunk{at, at + decoder.num_used(), num_points};
}

FoundChunks chunks_one_by_one(const ByteReader& file, const LasHeader& header, const LaszipRecord& laszip,
                              std::uint64_t end) {
  FoundChunks found;
  const bool says_where_they_end = laszip.is_layered || laszip.has_fixed_chunks;
  found.findings.push_back(
      {std::string("the table of the LAZ chunks is missing or damaged") +
           (says_where_they_end ? ": they are searched one after the other" : ", and nothing else says where they end"),
       0, "byte " + std::to_string(header.points_offset), true});
  const std::uint64_t highest = highest_number(header);
  std::uint64_t at = header.points_offset + kTableOffsetSize;
  while (says_where_they_end && at < end && found.most < highest) {
    const std::uint64_t num_points = std::min(laszip.points_per_chunk, highest - found.most);
    const std::optional<Chunk> chunk = laszip.is_layered
                                           ? next_layered_chunk(file, at, end, laszip)
                                           : next_pointwise_chunk(file, at, end, num_points, header, laszip);
    if (!chunk) break;
    found.chunks.push_back(*chunk);
    found.most += chunk->num_points;
    at = chunk->end;
  }
  found.least = found.most;
  return found;
}

// All points in one chunk, as the first LASzip wrote them: how many, the header alone knows.
FoundChunks chunk_of_all(const LasHeader& header, std::uint64_t end) {
  const std::uint64_t highest = highest_number(header);
  if (highest == kUnlimited || header.points_offset >= end) return {};
  return {{{header.points_offset, end, highest, false}}, 1, highest, {}};
}

FoundChunks look_for_chunks(const ByteReader& file, const LasHeader& header, const LasRecords& records,
                            const LaszipRecord& laszip) {
  const std::uint64_t end = end_of_points(file, records);
  if (!laszip.is_chunked) return chunk_of_all(header, end);
  const std::optional<ChunkTable> table = read_chunk_table(file, header, laszip);
  if (!table) return chunks_one_by_one(file, header, laszip, end);
  FoundChunks found = chunks_of_table(file, header, laszip, *table);
  const std::uint64_t end_of_last =
      found.chunks.empty() ? header.points_offset + kTableOffsetSize : found.chunks.back().end;
  const bool can_do_without = laszip.is_layered || laszip.has_fixed_chunks;
  // LASzip leaves no gaps: sizes that do leave one are not those of the chunks.
  if (end_of_last != table->begin && can_do_without) return chunks_one_by_one(file, header, laszip, table->begin);
  return found;
}

// Cuts the list behind a number of points.
void cut_chunks(std::vector<Chunk>& chunks, std::uint64_t num_points, bool is_last_number_known) {
  std::size_t num_chunks = 0;
  for (; num_chunks < chunks.size() && num_points > 0; ++num_chunks) {
    Chunk& chunk = chunks[num_chunks];
    const bool is_last = num_chunks + 1 == chunks.size();
    if (chunk.num_points > num_points) {
      chunk.num_points = num_points;
      if (!is_last || is_last_number_known) chunk.ends_exactly = false;
    }
    num_points -= chunk.num_points;
  }
  chunks.resize(num_chunks);
}

}  // namespace

std::uint64_t ChunkList::num_points() const {
  std::uint64_t sum = 0;
  for (const Chunk& chunk : chunks) sum += chunk.num_points;
  return sum;
}

ChunkList find_chunks(const ByteReader& file, const LasHeader& header, const LasRecords& records,
                      const LaszipRecord& laszip) {
  FoundChunks found = look_for_chunks(file, header, records, laszip);
  const LasPointCount count = choose_las_point_count(header, {found.least, found.most, false});
  cut_chunks(found.chunks, count.num_points, found.least == found.most);
  ChunkList list{std::move(found.chunks), std::move(found.findings)};
  list.findings.insert(list.findings.end(), count.findings.begin(), count.findings.end());
  return list;
}

}  // namespace vdbmap::laz
