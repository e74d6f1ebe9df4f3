// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/laz_points.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/laz/chunk_decoder.h"
#include "vdbmap/io/laz/chunk_list.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap::laz {
namespace {

constexpr std::size_t kPointsPerBlock = 256;

// A file whose chunks are decoded.
struct Source {
  const ByteReader& file;
  const LasHeader& header;
  LaszipRecord laszip;
};

std::string_view bytes_of(const Source& source, const Chunk& chunk) {
  return source.file.bytes_at(chunk.begin, chunk.end - chunk.begin);
}

// Why a chunk of these bytes cannot be decoded at all; empty where it can be tried.
std::string fault_of_front(const Source& source, const Chunk& chunk, std::string_view bytes) {
  if (bytes.size() < ChunkDecoder::least_size(source.laszip)) {
    return "has " + std::to_string(bytes.size()) + " bytes, expected at least " +
           std::to_string(ChunkDecoder::least_size(source.laszip));
  }
  if (!source.laszip.is_layered) return "";
  const auto front = read_layered_chunk_front(source.laszip, bytes);
  if (front->size != bytes.size()) {
    return "has layers of " + std::to_string(front->size) + " bytes in " + std::to_string(bytes.size());
  }
  if (front->num_points != chunk.num_points && chunk.ends_exactly) {
    return "says " + std::to_string(front->num_points) + " points, expected " + std::to_string(chunk.num_points);
  }
  return "";
}

// Decodes a chunk of these bytes block by block, each given to take(first point in the chunk, records, number); says
// what is wrong with it, or nothing. What was taken of a chunk that has a fault is worth nothing.
template <typename Take>
std::string decode_chunk(const Source& source, const Chunk& chunk, std::string_view bytes, const Take& take) {
  if (std::string fault = fault_of_front(source, chunk, bytes); !fault.empty()) return fault;
  ChunkDecoder decoder(source.laszip, bytes, LayerChoice::kOfCloud);
  std::vector<char> records(std::min<std::uint64_t>(kPointsPerBlock, chunk.num_points) * source.header.record_length);
  for (std::uint64_t first = 0; first < chunk.num_points; first += kPointsPerBlock) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kPointsPerBlock, chunk.num_points - first));
    decoder.decode(records.data(), count);
    if (decoder.is_beyond_end()) return "ends before its last point";
    take(static_cast<std::size_t>(first), records.data(), count);
  }
  return decoder.is_at_end() || !chunk.ends_exactly ? "" : "has more bytes than its points";
}

// Chunks that say more points than they have bytes are hardly true: they are decoded once to see. From the first one
// that is not true nothing of the list can be trusted.
void drop_incredible_chunks(const Source& source, ChunkList& list) {
  std::vector<char> is_true(list.chunks.size(), 1);
  parallel_for(list.chunks.size(), [&](std::size_t i) {
    const Chunk& chunk = list.chunks[i];
    if (chunk.num_points <= chunk.end - chunk.begin) return;
    const bool is_possible = chunk.num_points / kMostPointsPerByte <= chunk.end - chunk.begin;
    is_true[i] = is_possible && decode_chunk(source, chunk, bytes_of(source, chunk), [](auto...) {}).empty() ? 1 : 0;
  });
  const auto first = std::ranges::find(is_true, 0);
  if (first == is_true.end()) return;
  const auto number = static_cast<std::size_t>(first - is_true.begin());
  const Chunk& chunk = list.chunks[number];
  const std::string place = "chunk " + std::to_string(number + 1) + " says " + std::to_string(chunk.num_points) +
                            " in " + std::to_string(chunk.end - chunk.begin) + " bytes";
  const std::uint64_t num_before = list.num_points();
  list.chunks.resize(number);
  list.findings.push_back(
      {"points of LAZ chunks that cannot be true left out", num_before - list.num_points(), place, true});
}

// What became of a chunk.
struct Outcome {
  std::string fault;
  std::vector<std::size_t> withheld;
};

std::vector<Outcome> decode_chunks(const Source& source, std::span<const Chunk> chunks,
                                   const std::vector<std::size_t>& first_points, PointCloud& cloud) {
  // A reader on demand serves one thread at a time.
  std::vector<std::string_view> bytes;
  for (const Chunk& chunk : chunks) bytes.push_back(bytes_of(source, chunk));
  std::vector<Outcome> outcomes(chunks.size());
  parallel_for(chunks.size(), [&](std::size_t i) {
    Outcome& outcome = outcomes[i];
    outcome.fault =
        decode_chunk(source, chunks[i], bytes[i], [&](std::size_t first, const char* records, std::size_t count) {
          store_las_points(cloud, first_points[i] + first, records, count, source.header);
          append_withheld(outcome.withheld, first_points[i] + first, records, count, source.header);
        });
  });
  return outcomes;
}

void refuse_without_points(const ByteReader& file, const LasPoints& points) {
  if (!points.cloud.empty() || points.findings.empty()) return;
  throw IoError::malformed(file.path(), "no point can be read: " + points.findings.front().text());
}

std::vector<std::size_t> first_points_of(std::span<const Chunk> chunks) {
  std::vector<std::size_t> first_points;
  std::size_t sum = 0;
  for (const Chunk& chunk : chunks) {
    first_points.push_back(sum);
    sum += chunk.num_points;
  }
  return first_points;
}

}  // namespace

std::optional<LazChunks> LazChunks::find(const ByteReader& file, const LasHeader& header, const LasRecords& records) {
  const LaszipRecord laszip = read_laszip_record(file.path(), header, records.records);
  if (!laszip.is_chunked) return std::nullopt;
  ChunkList list = find_chunks(file, header, records, laszip);
  const bool is_credible =
      std::ranges::all_of(list.chunks, [](const Chunk& c) { return c.num_points <= c.end - c.begin; });
  if (!list.findings.empty() || !is_credible) return std::nullopt;
  return LazChunks(file, header, laszip, std::move(list.chunks));
}

std::uint64_t LazChunks::num_points() const {
  std::uint64_t sum = 0;
  for (const Chunk& chunk : chunks_) sum += chunk.num_points;
  return sum;
}

std::size_t LazChunks::count_within(std::size_t first, std::size_t most_points) const {
  std::size_t count = 1;
  std::uint64_t num_points = chunks_[first].num_points;
  for (; first + count < chunks_.size(); ++count) {
    num_points += chunks_[first + count].num_points;
    if (num_points > most_points) break;
  }
  return count;
}

LazChunks::Points LazChunks::read(std::size_t first, std::size_t count) const {
  const std::span<const Chunk> chunks = std::span(chunks_).subspan(first, count);
  const std::vector<std::size_t> first_points = first_points_of(chunks);
  Points points;
  points.cloud = make_las_cloud(*header_, first_points.back() + chunks.back().num_points);
  for (const Outcome& outcome : decode_chunks({*file_, *header_, laszip_}, chunks, first_points, points.cloud)) {
    points.has_left_out = points.has_left_out || !outcome.fault.empty() || !outcome.withheld.empty();
  }
  return points;
}

LasPoints read_laz_points(const ByteReader& file, const LasHeader& header, const LasRecords& records) {
  const Source source{file, header, read_laszip_record(file.path(), header, records.records)};
  ChunkList list = find_chunks(file, header, records, source.laszip);
  drop_incredible_chunks(source, list);

  LasPoints points;
  points.findings = std::move(list.findings);
  points.cloud = make_las_cloud(header, list.num_points());
  const std::vector<std::size_t> first_points = first_points_of(list.chunks);
  const std::vector<Outcome> outcomes = decode_chunks(source, list.chunks, first_points, points.cloud);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Chunk& chunk = list.chunks[i];
    if (outcomes[i].fault.empty()) {
      points.withheld.insert(points.withheld.end(), outcomes[i].withheld.begin(), outcomes[i].withheld.end());
      continue;
    }
    for (std::size_t k = 0; k < chunk.num_points; ++k) points.lost.push_back(first_points[i] + k);
    add_finding(
        points.findings,
        {"points of damaged LAZ chunks left out", chunk.num_points,
         "chunk " + std::to_string(i + 1) + " at byte " + std::to_string(chunk.begin) + " " + outcomes[i].fault, true});
  }
  remove_points(points.cloud, points.lost);
  refuse_without_points(file, points);
  finish_las_cloud(points.cloud);
  return points;
}

}  // namespace vdbmap::laz
