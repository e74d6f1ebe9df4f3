// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/ply/ply_header.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

using Words = std::vector<std::string_view>;

ScalarType parse_type(const ByteReader& reader, std::string_view word) {
  static const std::unordered_map<std::string_view, ScalarType> kTypes = {
      {"char", ScalarType::kInt8},       {"int8", ScalarType::kInt8},      {"uchar", ScalarType::kUint8},
      {"uint8", ScalarType::kUint8},     {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},   {"uint16", ScalarType::kUint16},  {"int", ScalarType::kInt32},
      {"int32", ScalarType::kInt32},     {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
      {"int64", ScalarType::kInt64},     {"uint64", ScalarType::kUint64},  {"float", ScalarType::kFloat32},
      {"float32", ScalarType::kFloat32}, {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64}};
  const auto found = kTypes.find(word);
  if (found == kTypes.end()) reader.fail_line("unknown number type " + quoted(word));
  return found->second;
}

PlyHeader::Encoding parse_encoding(const ByteReader& reader, const Words& words) {
  if (words.size() != 3) reader.fail_line("expected 'format ENCODING VERSION'");
  if (words[2] != "1.0") reader.fail_line("unknown PLY version " + quoted(words[2]) + ", expected '1.0'");
  if (words[1] == "ascii") return PlyHeader::Encoding::kAscii;
  if (words[1] == "binary_little_endian") return PlyHeader::Encoding::kBinaryLittleEndian;
  if (words[1] == "binary_big_endian") return PlyHeader::Encoding::kBinaryBigEndian;
  reader.fail_line("unknown encoding " + quoted(words[1]));
}

PlyElement parse_element(const ByteReader& reader, const Words& words) {
  if (words.size() != 3) reader.fail_line("expected 'element NAME COUNT'");
  const std::optional<std::uint64_t> count = parse_count(words[2]);
  if (!count) reader.fail_line(quoted(words[2]) + " is not a number of elements");
  return {lower_case(words[1]), *count, reader.line(), {}};
}

PlyProperty parse_property(const ByteReader& reader, const Words& words) {
  if (words.size() == 3) {
    return {std::string(words[2]), parse_type(reader, words[1]), std::nullopt, reader.line()};
  }
  if (words.size() != 5 || words[1] != "list") {
    reader.fail_line("expected 'property TYPE NAME' or 'property list COUNT_TYPE TYPE NAME'");
  }
  const ScalarType count_type = parse_type(reader, words[2]);
  if (!is_integer(count_type))
    reader.fail_line("the length of a list is " + quoted(words[2]) + ", expected an integer");
  return {std::string(words[4]), parse_type(reader, words[3]), count_type, reader.line()};
}

void read_magic(ByteReader& reader) {
  const std::string_view first = without_byte_order_mark(reader.read_line());
  std::string_view rest = first;
  if (lower_case(next_word(rest)) != "ply" || !next_word(rest).empty())
    reader.fail_line("found " + quoted(first) + ", expected 'ply'");
}

}  // namespace

bool PlyElement::has_lists() const {
  return std::ranges::any_of(properties, [](const PlyProperty& property) { return property.count_type.has_value(); });
}

std::uint64_t PlyElement::least_binary_size() const {
  std::uint64_t size = 0;
  for (const PlyProperty& property : properties) size += size_of(property.count_type.value_or(property.type));
  return size;
}

PlyHeader read_ply_header(ByteReader& reader) {
  read_magic(reader);
  std::optional<PlyHeader::Encoding> encoding;
  std::vector<PlyElement> elements;
  bool has_16_bit_colors = false;
  while (true) {
    const Words words = read_header_words(reader);
    has_16_bit_colors = has_16_bit_colors || words == split_words(kPlyComment16Bits);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      encoding = parse_encoding(reader, words);
    } else if (words[0] == "element") {
      elements.push_back(parse_element(reader, words));
    } else if (words[0] == "property" && !elements.empty()) {
      elements.back().properties.push_back(parse_property(reader, words));
    } else {
      reader.fail_line("unexpected " + quoted(words[0]) + " in the header");
    }
  }
  if (!encoding) reader.fail_line("the header states no format");
  return {*encoding, std::move(elements), has_16_bit_colors};
}

}  // namespace vdbmap
