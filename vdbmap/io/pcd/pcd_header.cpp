// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/pcd/pcd_header.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

// Sums and products of sizes stay far from 2^64; no record is as long.
constexpr std::uint64_t kLargestCount = std::uint64_t{1} << 32;

struct Entry {
  std::uint64_t line = 0;
  std::vector<std::string_view> values;
};

// The lines of a header by their keyword.
class Entries {
 public:
  explicit Entries(ByteReader& reader) : reader_(reader) {
    while (!entries_.contains("DATA")) read_line(reader);
  }

  const Entry* find(std::string_view keyword) const {
    const auto found = entries_.find(keyword);
    return found == entries_.end() ? nullptr : &found->second;
  }

  const Entry& at(std::string_view keyword) const {
    if (const Entry* entry = find(keyword)) return *entry;
    reader_.fail_line("the header has no line " + std::string(keyword));
  }

  [[noreturn]] void fail(const Entry& entry, const std::string& reason) const {
    throw IoError::malformed_at_line(reader_.path(), entry.line, reason);
  }

 private:
  void read_line(ByteReader& reader) {
    static constexpr std::array<std::string_view, 11> kKeywords = {
        "VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    std::vector<std::string_view> words = read_header_words(reader);
    if (!words.empty() && reader.line() == 1) words[0] = without_byte_order_mark(words[0]);
    if (words.empty() || words[0].starts_with('#') || words[0].starts_with(".PCD")) return;
    const auto* const known = std::ranges::find_if(
        kKeywords, [&](std::string_view word) { return lower_case(word) == lower_case(words[0]); });
    if (known == kKeywords.end()) reader.fail_line("unexpected " + quoted(words[0]) + " in the header");
    const std::string_view keyword = *known == "COLUMNS" ? "FIELDS" : *known;
    words.erase(words.begin());
    if (!entries_.try_emplace(keyword, Entry{reader.line(), std::move(words)}).second) {
      reader.fail_line("a second line " + std::string(keyword));
    }
  }

  const ByteReader& reader_;
  std::map<std::string_view, Entry> entries_;
};

std::uint64_t parse_one_count(const Entries& entries, const Entry& entry, std::size_t index) {
  const std::optional<std::uint64_t> count = parse_count(entry.values[index]);
  if (!count) entries.fail(entry, quoted(entry.values[index]) + " is not a whole number");
  return *count;
}

std::optional<ScalarType> find_type(std::string_view type, std::uint64_t size) {
  static const std::map<std::pair<std::string_view, std::uint64_t>, ScalarType> kTypes = {
      {{"i", 1}, ScalarType::kInt8},    {{"u", 1}, ScalarType::kUint8},  {{"i", 2}, ScalarType::kInt16},
      {{"u", 2}, ScalarType::kUint16},  {{"i", 4}, ScalarType::kInt32},  {{"u", 4}, ScalarType::kUint32},
      {{"i", 8}, ScalarType::kInt64},   {{"u", 8}, ScalarType::kUint64}, {{"f", 4}, ScalarType::kFloat32},
      {{"f", 8}, ScalarType::kFloat64},
  };
  const std::string lower = lower_case(type);
  const auto found = kTypes.find({lower, size});
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

// A line with as many values as FIELDS has.
const Entry& entry_per_field(const Entries& entries, std::string_view keyword) {
  const Entry& entry = entries.at(keyword);
  const std::size_t num_fields = entries.at("FIELDS").values.size();
  if (entry.values.size() != num_fields) {
    entries.fail(entry, std::string(keyword) + " has " + std::to_string(entry.values.size()) + " values for " +
                            std::to_string(num_fields) + " fields");
  }
  return entry;
}

ScalarType parse_type(const Entries& entries, std::size_t index) {
  const Entry& types = entry_per_field(entries, "TYPE");
  const std::uint64_t size = parse_one_count(entries, entry_per_field(entries, "SIZE"), index);
  const std::optional<ScalarType> type = find_type(types.values[index], size);
  if (!type)
    entries.fail(types, "no number has type " + quoted(types.values[index]) + " and size " + std::to_string(size));
  return *type;
}

std::uint64_t parse_field_count(const Entries& entries, std::size_t index) {
  if (!entries.find("COUNT")) return 1;
  const Entry& counts = entry_per_field(entries, "COUNT");
  const std::uint64_t count = parse_one_count(entries, counts, index);
  if (count < 1 || count > kLargestCount) {
    entries.fail(counts, "a field cannot have " + std::to_string(count) + " numbers");
  }
  return count;
}

std::vector<PcdField> parse_fields(const Entries& entries) {
  std::vector<PcdField> fields;
  const std::vector<std::string_view>& names = entries.at("FIELDS").values;
  for (std::size_t i = 0; i < names.size(); ++i) {
    fields.push_back({std::string(names[i]), parse_type(entries, i), parse_field_count(entries, i)});
  }
  return fields;
}

std::uint64_t parse_single(const Entries& entries, std::string_view keyword) {
  const Entry& entry = entries.at(keyword);
  if (entry.values.size() != 1) entries.fail(entry, "expected '" + std::string(keyword) + " NUMBER'");
  return parse_one_count(entries, entry, 0);
}

std::uint64_t parse_area(const Entries& entries) {
  const std::uint64_t width = parse_single(entries, "WIDTH");
  const std::uint64_t height = entries.find("HEIGHT") ? parse_single(entries, "HEIGHT") : 1;
  std::uint64_t area = 0;
  if (__builtin_mul_overflow(width, height, &area)) entries.fail(entries.at("WIDTH"), "WIDTH x HEIGHT exceeds 2^64");
  return area;
}

std::uint64_t parse_num_points(const Entries& entries, std::vector<ReadFinding>& findings) {
  if (!entries.find("WIDTH")) return parse_single(entries, "POINTS");
  const std::uint64_t area = parse_area(entries);
  if (!entries.find("POINTS")) return area;
  const std::uint64_t num_points = parse_single(entries, "POINTS");
  if (num_points != area) {
    findings.push_back({"the header contradicts itself", 0,
                        "POINTS is " + std::to_string(num_points) + ", WIDTH x HEIGHT " + std::to_string(area), true});
  }
  return std::max(num_points, area);
}

PcdEncoding parse_encoding(const Entries& entries) {
  const Entry& data = entries.at("DATA");
  if (data.values.size() != 1) entries.fail(data, "expected 'DATA ENCODING'");
  const std::string encoding = lower_case(data.values[0]);
  if (encoding == "ascii") return PcdEncoding::kAscii;
  if (encoding == "binary") return PcdEncoding::kBinary;
  if (encoding == "binary_compressed") return PcdEncoding::kBinaryCompressed;
  entries.fail(data, "unknown encoding " + quoted(data.values[0]));
}

}  // namespace

std::uint64_t PcdHeader::point_size() const {
  std::uint64_t size = 0;
  for (const PcdField& field : fields) size += field.size();
  return size;
}

std::uint64_t PcdHeader::numbers_per_point() const {
  std::uint64_t count = 0;
  for (const PcdField& field : fields) count += field.count;
  return count;
}

PcdHeader read_pcd_header(ByteReader& reader) {
  const Entries entries(reader);
  PcdHeader header;
  header.fields = parse_fields(entries);
  header.fields_line = entries.at("FIELDS").line;
  header.num_points = parse_num_points(entries, header.findings);
  header.num_points_line = entries.at(entries.find("POINTS") ? "POINTS" : "WIDTH").line;
  header.encoding = parse_encoding(entries);
  return header;
}

}  // namespace vdbmap
