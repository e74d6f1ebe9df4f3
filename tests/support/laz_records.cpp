// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/laz_records.h"

#include <gtest/gtest.h>

#include "vdbmap/io/las/las_point_count.h"
#include "vdbmap/io/laz/chunk_decoder.h"
#include "vdbmap/io/laz/chunk_list.h"

namespace vdbmap::test {

std::string point_records(const std::filesystem::path& path) {
  ByteReader file(path);
  const LasHeader header = read_las_header(file);
  const LasRecords records = read_las_records(file, header);
  if (!header.is_compressed) {
    const LasPointCount count = count_las_points(file, header, records);
    return std::string(file.all().substr(header.points_offset, count.num_points * header.record_length));
  }
  const laz::LaszipRecord laszip = laz::read_laszip_record(path, header, records.records);
  const laz::ChunkList list = laz::find_chunks(file, header, records, laszip);
  EXPECT_TRUE(list.findings.empty());
  std::string bytes(list.num_points() * header.record_length, '\0');
  char* next = bytes.data();
  for (const laz::Chunk& chunk : list.chunks) {
    const std::string_view chunk_bytes = file.all().substr(chunk.begin, chunk.end - chunk.begin);
    laz::ChunkDecoder decoder(laszip, chunk_bytes, laz::LayerChoice::kAll);
    decoder.decode(next, chunk.num_points);
    next += chunk.num_points * header.record_length;
    EXPECT_TRUE(decoder.is_at_end() || !chunk.ends_exactly) << path << " at byte " << chunk.begin;
  }
  return bytes;
}

}  // namespace vdbmap::test
