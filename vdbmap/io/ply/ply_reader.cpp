// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/ply/ply.h"
#include "vdbmap/io/ply/ply_header.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/points/point_collector.h"
#include "vdbmap/io/points/point_fields.h"
#include "vdbmap/io/table/word_points.h"

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
Fields choose_fields(const ByteReader& reader, const PlyElement& vertex, bool has_16_bit_colors) {
  std::vector<NamedField> numbers;
  for (const PlyProperty& property : vertex.properties) {
    numbers.push_back({property.count_type ? "" : property.name, property.type});
  }
  Fields fields = choose_point_fields(numbers);
  if (const auto missing = missing_coordinate(fields)) fail_without_coordinate(reader, vertex, *missing);
  for (std::optional<PointField>& field : fields) {
    if (field && has_16_bit_colors) field->scale_is_known = true;  // as 16 bits, unless it is of 8
  }
  return fields;
}

std::uint64_t most_elements(const ByteReader& reader, const PlyElement& element, bool is_text) {
  // In text a number takes a digit and a separator, which the end of the file may replace.
  const std::uint64_t least_size = is_text ? 2 * element.properties.size() : element.least_binary_size();
  const std::uint64_t available = reader.remaining() + (is_text ? 1 : 0);
  return least_size == 0 ? element.count : available / least_size;
}

// A header's word on the number of elements is worth what the rest of the file can hold.
void check_count(const ByteReader& reader, const PlyElement& element, bool is_text) {
  const std::uint64_t most = most_elements(reader, element, is_text);
  if (element.count <= most) return;
  throw IoError::malformed_at_line(reader.path(), element.line,
                                   "the header promises " + std::to_string(element.count) + " elements " +
                                       vdbmap::quoted(element.name) + ", the file holds at most " +
                                       std::to_string(most));
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

// The points that the header promises, or as many whole ones as there are.
struct Vertices {
  ReadResult read;
  std::uint64_t count = 0;  // broken ones included
};

WordPoints words_of(const PlyElement& vertex, const Fields& fields) {
  std::vector<WordColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    columns.push_back({vertex.properties[i].name, fields[i], vertex.properties[i].count_type.has_value()});
  }
  return {std::move(columns), "property"};
}

Vertices read_text_vertices(ByteReader& reader, const PlyElement& vertex, const Fields& fields) {
  WordPoints words = words_of(vertex, fields);
  words.read(reader, vertex.count);
  const std::uint64_t count = words.num_points();
  return {words.finish(reader.path(), {}), count};
}

// Vertices with lists differ in size: they are read one after the other, up to the first that is damaged.
Vertices read_uneven_vertices(ByteReader& reader, const PlyElement& vertex, const Fields& fields, std::endian order) {
  PointCollector collector(fields);
  try {
    while (collector.size() < vertex.count) {
      read_binary_element(reader, vertex, order, [&](std::size_t i, const char* bytes) {
        if (fields[i]) collector.set(i, load_number(bytes, type_to_load(*fields[i]), order));
      });
      collector.finish_point();
    }
  } catch (const IoError&) {
    if (collector.size() == 0) throw;
  }
  const std::uint64_t count = collector.size();
  return {finish_reading(reader.path(), collector.finish()), count};
}

Vertices read_even_vertices(ByteReader& reader, const PlyElement& vertex, const Fields& fields, std::endian order) {
  const std::uint64_t size = vertex.least_binary_size();
  const std::uint64_t count = std::min(vertex.count, reader.remaining() / size);
  const char* next = reader.bytes(count * size).data();
  std::vector<PointColumn> columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i]) columns.push_back({*fields[i], {next, size, type_to_load(*fields[i]), order}});
    next += size_of(vertex.properties[i].type);
  }
  PointCloud cloud = make_cloud(fields, count);
  store_columns(cloud, columns);
  if (count < vertex.count) reader.skip(reader.remaining());
  return {finish_reading(reader.path(), std::move(cloud)), count};
}

Vertices read_vertices(ByteReader& reader, const PlyElement& vertex, const PlyHeader& header) {
  const Fields fields = choose_fields(reader, vertex, header.has_16_bit_colors);
  const bool is_text = header.encoding == PlyHeader::Encoding::kAscii;
  if (most_elements(reader, vertex, is_text) == 0) check_count(reader, vertex, is_text);
  if (is_text) return read_text_vertices(reader, vertex, fields);
  if (vertex.has_lists()) return read_uneven_vertices(reader, vertex, fields, byte_order(header.encoding));
  return read_even_vertices(reader, vertex, fields, byte_order(header.encoding));
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

// Elements behind the points are not needed; what is wrong with them shows that the file is damaged.
void check_rest(ByteReader& reader, std::span<const PlyElement> elements, const PlyHeader& header,
                std::vector<ReadFinding>& findings) {
  const bool is_text = header.encoding == PlyHeader::Encoding::kAscii;
  for (const PlyElement& element : elements) {
    try {
      check_count(reader, element, is_text);
      skip_element(reader, element, header.encoding);
    } catch (const IoError&) {
      findings.push_back(
          {"elements " + vdbmap::quoted(element.name) + " behind the points are cut or damaged", 0, "", true});
      return;
    }
  }
  const std::string_view rest = reader.bytes(reader.remaining());
  if (rest.find_first_not_of(std::string_view(" \t\r\n\0", 5)) == std::string_view::npos) return;
  findings.push_back({"bytes behind the last element passed over", rest.size()});
}

}  // namespace

ReadResult read_ply(const std::filesystem::path& path) {
  ByteReader reader(path);
  const PlyHeader header = read_ply_header(reader);
  const auto vertex = std::ranges::find(header.elements, "vertex", &PlyElement::name);
  if (vertex == header.elements.end()) reader.fail_line("the header has no element 'vertex'");

  for (auto element = header.elements.begin(); element != vertex; ++element) {
    check_count(reader, *element, header.encoding == PlyHeader::Encoding::kAscii);
    skip_element(reader, *element, header.encoding);
  }
  Vertices vertices = read_vertices(reader, *vertex, header);
  std::vector<ReadFinding>& findings = vertices.read.findings;
  if (vertices.count < vertex->count) {
    findings.push_back(missing_points(vertex->count, vertices.count));
  } else {
    check_rest(reader, {vertex + 1, header.elements.end()}, header, findings);
  }
  return std::move(vertices.read);
}

}  // namespace vdbmap
