// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string_view>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/byte_reader.h"
#include "vdbmap/io/ply.h"
#include "vdbmap/io/ply_header.h"
#include "vdbmap/io/point_cloud_filter.h"
#include "vdbmap/io/point_fields.h"
#include "vdbmap/io/text.h"

namespace vdbmap {
namespace {

using Fields = std::vector<std::optional<PointField>>;

std::endian byte_order(PlyHeader::Encoding encoding) {
  return encoding == PlyHeader::Encoding::kBinaryBigEndian ? std::endian::big : std::endian::little;
}

const PlyProperty* find_property(const PlyElement& vertex, const std::string& name) {
  const auto found = std::ranges::find(vertex.properties, name, &PlyProperty::name);
  return found == vertex.properties.end() ? nullptr : &*found;
}

[[noreturn]] void fail_without_coordinate(const ByteReader& reader, const PlyElement& vertex, const std::string& name) {
  const PlyProperty* property = find_property(vertex, name);
  const std::string reason = property ? "property '" + name + "' is a list, expected a number"
                                      : "the vertices have no property '" + name + "'";
  throw IoError::malformed_at_line(reader.path(), property ? property->line : vertex.line, reason);
}

// The place of each property in a PointCloud; lists have none.
Fields choose_fields(const ByteReader& reader, const PlyElement& vertex) {
  std::vector<NamedField> numbers;
  for (const PlyProperty& property : vertex.properties) {
    numbers.push_back({property.count_type ? "" : property.name, property.type});
  }
  Fields fields = choose_point_fields(numbers);
  if (const auto missing = missing_coordinate(fields)) fail_without_coordinate(reader, vertex, *missing);
  return fields;
}

// A header's word on the number of elements is worth what the rest of the file can hold.
void check_count(const ByteReader& reader, const PlyElement& element, bool is_text) {
  // In text a number takes a digit and a separator, which the end of the file may replace.
  const std::uint64_t least_size = is_text ? 2 * element.properties.size() : element.least_binary_size();
  const std::uint64_t available = reader.remaining() + (is_text ? 1 : 0);
  if (least_size == 0 || element.count <= available / least_size) return;
  throw IoError::malformed_at_line(reader.path(), element.line,
                                   "the header promises " + std::to_string(element.count) + " elements " +
                                       vdbmap::quoted(element.name) + ", the file holds at most " +
                                       std::to_string(available / least_size));
}

void skip_binary_list(ByteReader& reader, const PlyProperty& list, std::endian order) {
  const std::uint64_t begin = reader.offset();
  const double length = load_number(reader.bytes(size_of(*list.count_type)).data(), *list.count_type, order);
  const double num_bytes = length * static_cast<double>(size_of(list.type));
  if (length < 0 || num_bytes > static_cast<double>(reader.remaining())) {
    std::string reason = "the file cannot hold a list " + vdbmap::quoted(list.name) + " of length ";
    append_text(reason, length, ScalarType::kFloat64);
    throw IoError::malformed_at_byte(reader.path(), begin, reason);
  }
  reader.skip(static_cast<std::uint64_t>(num_bytes));
}

// Calls on_number(index of the property, its bytes) for each property that is not a list.
template <typename OnNumber>
void read_binary_element(ByteReader& reader, const PlyElement& element, std::endian order, OnNumber&& on_number) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.count_type) {
      skip_binary_list(reader, property, order);
    } else {
      on_number(i, reader.bytes(size_of(property.type)).data());
    }
  }
}

double read_word(const ByteReader& reader, std::string_view& rest, const PlyProperty& property) {
  const std::string_view word = next_word(rest);
  if (word.empty()) reader.fail_line("the line ends before property " + vdbmap::quoted(property.name));
  const std::optional<double> number = parse_number(word);
  if (!number)
    reader.fail_line("property " + vdbmap::quoted(property.name) + " is " + quoted(word) + ", expected a number");
  return *number;
}

void skip_text_list(const ByteReader& reader, std::string_view& rest, const PlyProperty& list) {
  const double length = read_word(reader, rest, list);
  for (double i = 0; i < length; ++i) read_word(reader, rest, list);
}

// Calls on_number(index of the property, its number) for each property that is not a list.
template <typename OnNumber>
void read_text_element(ByteReader& reader, const PlyElement& element, OnNumber&& on_number) {
  std::string_view rest = read_filled_line(reader);
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].count_type) {
      skip_text_list(reader, rest, element.properties[i]);
    } else {
      on_number(i, read_word(reader, rest, element.properties[i]));
    }
  }
  if (const auto surplus = next_word(rest); !surplus.empty()) {
    reader.fail_line("found " + quoted(surplus) + " after the last property");
  }
}

void store_number(PointCloud& cloud, const std::optional<PointField>& field, std::size_t point, double number) {
  if (field) store_numbers(cloud, *field, point, {&number, 1});
}

PointCloud read_text_vertices(ByteReader& reader, const PlyElement& vertex, const Fields& fields) {
  PointCloud cloud = make_cloud(fields, vertex.count);
  for (std::size_t point = 0; point < vertex.count; ++point) {
    read_text_element(reader, vertex, [&](std::size_t i, double number) {
      if (fields[i]) store_number(cloud, fields[i], point, number_from_text(*fields[i], number));
    });
  }
  return cloud;
}

// Vertices with lists differ in size: they are read one after the other.
PointCloud read_uneven_vertices(ByteReader& reader, const PlyElement& vertex, const Fields& fields, std::endian order) {
  PointCloud cloud = make_cloud(fields, vertex.count);
  for (std::size_t point = 0; point < vertex.count; ++point) {
    read_binary_element(reader, vertex, order, [&](std::size_t i, const char* bytes) {
      if (fields[i]) store_number(cloud, fields[i], point, load_number(bytes, type_to_load(*fields[i]), order));
    });
  }
  return cloud;
}

PointCloud read_even_vertices(ByteReader& reader, const PlyElement& vertex, const Fields& fields, std::endian order) {
  const std::uint64_t size = vertex.least_binary_size();
  const char* next = reader.bytes(vertex.count * size).data();
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i]) columns.push_back({*fields[i], {next, size, type_to_load(*fields[i]), order}});
    next += size_of(vertex.properties[i].type);
  }
  PointCloud cloud = make_cloud(fields, vertex.count);
  store_columns(cloud, columns);
  return cloud;
}

PointCloud read_vertices(ByteReader& reader, const PlyElement& vertex, PlyHeader::Encoding encoding) {
  const Fields fields = choose_fields(reader, vertex);
  if (encoding == PlyHeader::Encoding::kAscii) return read_text_vertices(reader, vertex, fields);
  if (vertex.has_lists()) return read_uneven_vertices(reader, vertex, fields, byte_order(encoding));
  return read_even_vertices(reader, vertex, fields, byte_order(encoding));
}

void skip_element(ByteReader& reader, const PlyElement& element, PlyHeader::Encoding encoding) {
  if (element.properties.empty()) return;
  if (encoding != PlyHeader::Encoding::kAscii && !element.has_lists()) {
    return reader.skip(element.count * element.least_binary_size());
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (encoding == PlyHeader::Encoding::kAscii) {
      read_filled_line(reader);
    } else {
      read_binary_element(reader, element, byte_order(encoding), [](std::size_t, const char*) {});
    }
  }
}

}  // namespace

ReadResult read_ply(const std::filesystem::path& path) {
  ByteReader reader(path);
  const PlyHeader header = read_ply_header(reader);
  const auto vertex = std::ranges::find(header.elements, "vertex", &PlyElement::name);
  if (vertex == header.elements.end()) reader.fail_line("the header has no element 'vertex'");

  PointCloud cloud;
  for (const PlyElement& element : header.elements) {
    check_count(reader, element, header.encoding == PlyHeader::Encoding::kAscii);
    if (&element == &*vertex) {
      cloud = read_vertices(reader, element, header.encoding);
    } else {
      skip_element(reader, element, header.encoding);  // also behind the vertices: a file cut short there is damaged
    }
  }
  return finish_reading(path, std::move(cloud));
}

}  // namespace vdbmap
