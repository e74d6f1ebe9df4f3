// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/laz/laszip_record.h"

#include <algorithm>
#include <limits>
#include <string>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap::laz {
namespace {

constexpr std::string_view kLaszipUser = "laszip encoded";

// Where the record holds what.
constexpr std::size_t kCompressorAt = 0;
constexpr std::size_t kCoderAt = 2;
constexpr std::size_t kChunkSizeAt = 12;
constexpr std::size_t kNumItemsAt = 32;
constexpr std::size_t kItemsAt = 34;
constexpr std::size_t kItemSize = 6;  // type, size and version

enum Compressor : unsigned { kNone, kPointwise, kPointwiseChunked, kLayeredChunked };

enum ItemType : unsigned { kBytes = 0, kPoint = 6, kTime = 7, kColor = 8, kWaveform = 9 };
enum LayeredItemType : unsigned {
  kPoint14 = 10,
  kColor14 = 11,
  kColorInfrared14 = 12,
  kWaveform14 = 13,
  kBytes14 = 14
};

struct Item {
  unsigned type = 0;
  std::size_t size = 0;
  unsigned version = 0;
};

std::string to_text(const std::vector<Item>& items) {
  std::string text;
  for (const Item& item : items) {
    text += (text.empty() ? "" : ", ") + std::to_string(item.type) + " of " + std::to_string(item.size) +
            " bytes in version " + std::to_string(item.version);
  }
  return text.empty() ? "none" : text;
}

std::vector<Item> read_items(std::string_view data) {
  std::vector<Item> items;
  const std::size_t count = load<std::uint16_t>(data.data() + kNumItemsAt);
  for (std::size_t i = 0; i < count && data.size() >= kItemsAt + kItemSize * (i + 1); ++i) {
    const char* item = data.data() + kItemsAt + kItemSize * i;
    items.push_back({load<std::uint16_t>(item), load<std::uint16_t>(item + 2), load<std::uint16_t>(item + 4)});
  }
  return items;
}

// What LASzip makes of a point format; the versions are those of the file.
std::vector<Item> expected_items(const LasHeader& header, unsigned version) {
  const unsigned format = header.format_number;
  const std::size_t num_extra_bytes = header.record_length - header.format.length;
  std::vector<Item> items;
  if (format >= 6) {
    items.push_back({kPoint14, 30, version});
    if (format == 7) items.push_back({kColor14, 6, version});
    if (format == 8) items.push_back({kColorInfrared14, 8, version});
    if (num_extra_bytes > 0) items.push_back({kBytes14, num_extra_bytes, version});
  } else {
    items.push_back({kPoint, 20, version});
    if (header.format.time_at) items.push_back({kTime, 8, version});
    if (header.format.color_at) items.push_back({kColor, 6, version});
    if (num_extra_bytes > 0) items.push_back({kBytes, num_extra_bytes, version});
  }
  return items;
}

bool are_equal(const std::vector<Item>& a, const std::vector<Item>& b) {
  return std::ranges::equal(a, b, [](const Item& first, const Item& second) {
    return first.type == second.type && first.size == second.size && first.version == second.version;
  });
}

bool is_waveform(unsigned format) { return format == 4 || format == 5 || format == 9 || format == 10; }

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw IoError::malformed(path, "LAZ: " + reason);
}

std::string_view find_data(const std::filesystem::path& path, const std::vector<LasRecord>& records) {
  const auto found = std::ranges::find(records, kLaszipUser, &LasRecord::user);
  if (found == records.end()) {
    fail(path, "the header says that the points are compressed, but the record that says how is missing");
  }
  if (found->data.size() < kItemsAt) {
    fail(path, "the record that says how points are compressed has " + std::to_string(found->data.size()) +
                   " bytes, expected at least " + std::to_string(kItemsAt));
  }
  return found->data;
}

unsigned read_compressor(const std::filesystem::path& path, std::string_view data, const LasHeader& header) {
  const unsigned compressor = load<std::uint16_t>(data.data() + kCompressorAt);
  const unsigned coder = load<std::uint16_t>(data.data() + kCoderAt);
  const bool is_layered = header.format_number >= 6;
  const bool is_known =
      is_layered ? compressor == kLayeredChunked : compressor == kPointwise || compressor == kPointwiseChunked;
  if (!is_known) {
    fail(path, "compressor " + std::to_string(compressor) + " of point format " + std::to_string(header.format_number) +
                   ", expected " + (is_layered ? "3" : "1 or 2"));
  }
  if (coder != 0) fail(path, "coder " + std::to_string(coder) + ", expected 0");
  return compressor;
}

}  // namespace

bool is_compressed(const std::vector<LasRecord>& records) {
  return std::ranges::find(records, kLaszipUser, &LasRecord::user) != records.end();
}

LaszipRecord read_laszip_record(const std::filesystem::path& path, const LasHeader& header,
                                const std::vector<LasRecord>& records) {
  if (is_waveform(header.format_number)) {
    fail(path, "compressed waveforms (point format " + std::to_string(header.format_number) + ") are not read");
  }
  const std::string_view data = find_data(path, records);
  const unsigned compressor = read_compressor(path, data, header);

  LaszipRecord record;
  record.is_layered = compressor == kLayeredChunked;
  record.is_chunked = compressor != kPointwise;
  record.points_per_chunk = load<std::uint32_t>(data.data() + kChunkSizeAt);
  record.has_fixed_chunks = record.points_per_chunk != std::numeric_limits<std::uint32_t>::max();
  if (record.is_chunked && record.points_per_chunk == 0) fail(path, "chunks of no points");

  const std::vector<Item> items = read_items(data);
  record.version = items.empty() ? 0 : items.front().version;
  const bool is_known =
      record.is_layered ? record.version == 3 || record.version == 4 : record.version == 1 || record.version == 2;
  const std::vector<Item> expected = expected_items(header, record.version);
  if (!is_known || !are_equal(items, expected)) {
    fail(path, "compressed items " + to_text(items) + ", expected " + to_text(expected));
  }
  record.has_time = header.format.time_at.has_value();
  record.has_color = header.format.color_at.has_value();
  record.has_infrared = header.format_number == 8;
  record.num_extra_bytes = header.record_length - header.format.length;
  return record;
}

}  // namespace vdbmap::laz
