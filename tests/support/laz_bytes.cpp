// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/laz_bytes.h"

#include <algorithm>
#include <array>
#include <random>

#include "tests/support/las_bytes.h"
#include "tests/support/laz_coders.h"
#include "tests/support/laz_points.h"
#include "vdbmap/io/laz/point_records.h"

namespace vdbmap::test {
namespace {

using laz::store;

// Of the header of a LAS file (LAS 1.4-R15, table 3).
struct LasFront {
  unsigned minor_version;
  std::uint32_t points_offset;
  std::uint32_t num_records;
  std::uint64_t num_points;
  std::uint64_t extended_offset = 0;
  LazItems items;
};

LasFront read_front_of(std::string_view las) {
  const char* bytes = las.data();
  LasFront front;
  front.minor_version = load<std::uint8_t>(bytes + 25);
  front.points_offset = load<std::uint32_t>(bytes + 96);
  front.num_records = load<std::uint32_t>(bytes + 100);
  front.num_points = load<std::uint32_t>(bytes + 107);
  if (front.minor_version >= 4) {
    front.extended_offset = load<std::uint64_t>(bytes + 235);
    front.num_points = load<std::uint64_t>(bytes + 247);
  }
  front.items.format = load<std::uint8_t>(bytes + 104);
  front.items.num_extra_bytes = load<std::uint16_t>(bytes + 105) - front.items.record_length();
  return front;
}

std::string laszip_record(const LazItems& items, const LazLayout& layout) {
  struct Item {
    unsigned type;
    std::size_t size;
  };
  std::vector<Item> list;
  if (items.is_layered()) {
    list.push_back({10, 30});
    if (items.format == 7) list.push_back({11, 6});
    if (items.format == 8) list.push_back({12, 8});
    if (items.num_extra_bytes > 0) list.push_back({14, items.num_extra_bytes});
  } else {
    list.push_back({6, 20});
    if (items.has_time()) list.push_back({7, 8});
    if (items.has_color()) list.push_back({8, 6});
    if (items.num_extra_bytes > 0) list.push_back({0, items.num_extra_bytes});
  }
  std::string data;
  put(data, items.is_layered() ? 3 : layout.is_chunked ? 2 : 1, 2);
  put(data, 0, 2);
  put(data, 0x0202, 4);  // version
  put(data, 0, 4);
  put(data, layout.chunk_sizes.empty() ? layout.points_per_chunk : 0xffffffff, 4);
  put(data, 0xffffffffffffffff, 8);
  put(data, 0xffffffffffffffff, 8);
  put(data, list.size(), 2);
  for (const Item& item : list) {
    put(data, item.type, 2);
    put(data, item.size, 2);
    put(data, items.version, 2);
  }
  std::string record;
  put(record, 0, 2);
  record += std::string("laszip encoded").append(2, '\0');
  put(record, 22204, 2);
  put(record, data.size(), 2);
  record += std::string("made by a test").append(18, '\0');
  return record + data;
}

std::vector<std::size_t> sizes_of_chunks(const LazLayout& layout, std::size_t num_points) {
  if (!layout.chunk_sizes.empty()) return layout.chunk_sizes;
  const std::size_t most = layout.is_chunked ? layout.points_per_chunk : num_points;
  std::vector<std::size_t> sizes;
  for (std::size_t rest = num_points; rest > 0; rest -= sizes.back()) sizes.push_back(std::min(rest, most));
  return sizes;
}

std::string chunk_table(const std::vector<std::string>& chunks, const std::vector<std::size_t>& sizes,
                        const LazLayout& layout) {
  std::string table;
  put(table, 0, 4);
  put(table, chunks.size(), 4);
  if (chunks.empty()) return table;
  ArithmeticEncoder encoder;
  IntegerEncoder<32> integers(2);
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const auto before = [&](const auto& value) { return static_cast<std::uint32_t>(i == 0 ? 0 : value(i - 1)); };
    const auto num_points = [&](std::size_t k) { return sizes[k]; };
    const auto num_bytes = [&](std::size_t k) { return chunks[k].size(); };
    if (!layout.chunk_sizes.empty()) {
      integers.encode(encoder, before(num_points), static_cast<std::uint32_t>(sizes[i]), 0);
    }
    integers.encode(encoder, before(num_bytes), static_cast<std::uint32_t>(chunks[i].size()), 1);
  }
  return table + encoder.finish();
}

// Points one after the other, with now and then something else.
class RandomRecords {
 public:
  RandomRecords(const LazItems& items, std::uint64_t seed) : items_(items), random_(seed) {}

  std::string next() {
    move();
    std::string record(items_.record_length(), '\0');
    for (std::size_t axis = 0; axis < 3; ++axis) store(record.data() + 4 * axis, position_[axis]);
    store(record.data() + 12, static_cast<std::uint16_t>(one_in(4) ? random_() : 200 + random_() % 30));
    items_.is_layered() ? put_layered(record) : put_pointwise(record);
    const std::size_t color_at = items_.is_layered() ? 30 : items_.has_time() ? 28 : 20;
    if (items_.has_color()) put_color(record.data() + color_at);
    if (items_.has_infrared()) store(record.data() + color_at + 6, infrared_ = change(infrared_));
    for (std::size_t i = 0; i < items_.num_extra_bytes; ++i) {
      record[record.size() - 1 - i] = static_cast<char>(i % 3 == 1 ? 7 : random_() % (i + 2));
    }
    return record;
  }

 private:
  bool one_in(unsigned count) { return random_() % count == 0; }

  std::uint16_t change(std::uint16_t value) {
    return one_in(3) ? value : static_cast<std::uint16_t>(one_in(9) ? random_() : value + random_() % 9 - 4);
  }

  void move() {
    for (std::uint32_t& coordinate : position_) {
      if (one_in(60)) {
        coordinate = static_cast<std::uint32_t>(random_());
      } else if (!one_in(5)) {
        coordinate += static_cast<std::uint32_t>(random_() % 200 - 60);
      }
    }
    if (number_ < num_returns_ && !one_in(20)) {
      ++number_;
    } else {
      num_returns_ = one_in(3) ? 1 + random_() % (items_.is_layered() ? 9 : 5) : 1;
      number_ = one_in(40) ? random_() % 8 : 1;
      advance_time();
    }
    if (one_in(7)) channel_ = random_() % 4;
    if (one_in(30)) source_ = static_cast<std::uint16_t>(random_());
    if (one_in(15)) scan_angle_ = static_cast<std::uint16_t>(scan_angle_ + random_() % 41 - 20);
    if (one_in(12)) classification_ = random_() % (items_.is_layered() ? 70 : 32);
    if (one_in(25)) user_data_ = random_() % 256;
    if (one_in(50)) flags_ = random_() % 4;
  }

  void advance_time() {
    double& time = times_[one_in(20) ? sequence_ = random_() % times_.size() : sequence_];
    if (one_in(30)) {
      time = static_cast<double>(random_() % 1000000000);
    } else {
      time += 1e-5 * static_cast<double>(one_in(8) ? random_() % 7000 : 1);
      if (one_in(25)) time -= 2e-4;
    }
    time_ = time;
  }

  void put_pointwise(std::string& record) {
    record[14] = static_cast<char>((number_ & 7) | (num_returns_ & 7) << 3 | (flags_ & 3) << 6);
    record[15] = static_cast<char>(classification_);
    record[16] = static_cast<char>(scan_angle_);
    record[17] = static_cast<char>(user_data_);
    store(record.data() + 18, source_);
    if (items_.has_time()) store(record.data() + 20, time_);
  }

  void put_layered(std::string& record) {
    record[14] = static_cast<char>((number_ & 15) | (num_returns_ & 15) << 4);
    record[15] = static_cast<char>(flags_ % 2 | (channel_ & 3) << 4 | (flags_ & 3) << 6);  // 4 withholds
    record[16] = static_cast<char>(classification_);
    record[17] = static_cast<char>(user_data_);
    store(record.data() + 18, scan_angle_);
    store(record.data() + 20, source_);
    store(record.data() + 22, time_);
  }

  void put_color(char* bytes) {
    color_[0] = change(color_[0]);
    const bool is_grey = one_in(4);
    for (std::size_t i = 1; i < 3; ++i) color_[i] = is_grey ? color_[0] : change(color_[i]);
    laz::store_channels(bytes, color_);
  }

  LazItems items_;
  std::mt19937_64 random_;
  std::array<std::uint32_t, 3> position_{1000, 2000, 3000};
  std::uint64_t number_ = 1;
  std::uint64_t num_returns_ = 1;
  std::uint64_t channel_ = 0;
  std::uint64_t classification_ = 2;
  std::uint64_t user_data_ = 0;
  std::uint64_t flags_ = 0;
  std::uint16_t source_ = 17;
  std::uint16_t scan_angle_ = 0;
  std::array<double, 5> times_{1e5, 2e5, 3e5, 4e8, 5e8};
  std::size_t sequence_ = 0;
  double time_ = 1e5;
  laz::Channels color_{20000, 21000, 22000};
  std::uint16_t infrared_ = 500;
};

}  // namespace

std::string compress_las(std::string_view las, const LazLayout& layout) {
  LasFront front = read_front_of(las);
  LazItems& items = front.items;
  items.version = layout.version != 0 ? layout.version : items.is_layered() ? 3 : 2;
  const std::size_t length = items.record_length();
  std::string_view records = las.substr(front.points_offset, front.num_points * length);
  const std::string_view behind = las.substr(front.points_offset + records.size());

  const std::vector<std::size_t> sizes = sizes_of_chunks(layout, front.num_points);
  std::vector<std::string> chunks;
  for (const std::size_t size : sizes) {
    chunks.push_back(compress_chunk(items, records.substr(0, size * length)));
    records.remove_prefix(size * length);
  }
  std::string points;
  for (const std::string& chunk : chunks) points += chunk;

  const std::string record = laszip_record(items, layout);
  std::string laz = std::string(las.substr(0, front.points_offset)) + record;
  store(laz.data() + 96, static_cast<std::uint32_t>(laz.size()));
  store(laz.data() + 100, front.num_records + 1);
  laz[104] = static_cast<char>(items.format | 0x80);
  const bool has_offset = layout.is_chunked || items.is_layered();
  const std::uint64_t table_at = laz.size() + 8 + points.size();
  if (has_offset) put(laz, layout.has_table && !layout.has_offset_behind ? table_at : 0xffffffffffffffff, 8);
  laz += points;
  if (has_offset && layout.has_table) laz += chunk_table(chunks, sizes, layout);
  if (front.extended_offset != 0) store(laz.data() + 235, std::uint64_t{laz.size()});
  laz += behind;
  if (layout.has_offset_behind) put(laz, table_at, 8);
  return laz;
}

std::string random_las(unsigned format, std::size_t num_points, std::size_t num_extra_bytes, std::uint64_t seed) {
  LasBytes las;
  las.format = format;
  las.minor_version = format >= 6 ? 4 : 2;
  las.num_extra_bytes = num_extra_bytes;
  las.points.resize(num_points);
  las.records = {{"LASF_Projection", 34735, geo_keys({{1024, 1}, {3072, 25832}})}};
  std::string bytes = las.bytes();
  std::size_t at = load<std::uint32_t>(bytes.data() + 96);
  RandomRecords records({format, 2, num_extra_bytes}, seed);
  for (std::size_t i = 0; i < num_points; ++i) {
    const std::string record = records.next();
    bytes.replace(at, record.size(), record);
    at += record.size();
  }
  return bytes;
}

}  // namespace vdbmap::test
