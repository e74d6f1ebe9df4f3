// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_point_count.h"
#include "vdbmap/io/las/las_records.h"
#include "vdbmap/io/las/las_reference_system.h"
#include "vdbmap/io/points/color_range.h"
#include "vdbmap/io/points/coordinate_kind.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

constexpr std::size_t kIntensityAt = 12;

// One value a point record, by a function of the record's first byte.
template <typename T, typename Read>
std::vector<T> read_column(const char* first_record, const LasHeader& header, Read&& read) {
  std::vector<T> values(header.num_points);
  const char* record = first_record;
  for (T& value : values) {
    value = static_cast<T>(read(record));
    record += header.record_length;
  }
  return values;
}

// The specification says for intensities that 0 stands for an attribute the source did not have.
template <typename T>
void forget_if_all_zero(std::vector<T>& values) {
  if (std::ranges::all_of(values, [](const T& value) { return value == T{}; })) values = {};
}

std::vector<Eigen::Vector3d> read_positions(const char* first_record, const LasHeader& header) {
  return read_column<Eigen::Vector3d>(first_record, header, [&](const char* record) -> Eigen::Vector3d {
    const Eigen::Vector3d quanta(load<std::int32_t>(record), load<std::int32_t>(record + 4),
                                 load<std::int32_t>(record + 8));
    return quanta.cwiseProduct(header.scale) + header.offset;
  });
}

std::vector<Rgb16> read_colors(const char* first_record, const LasHeader& header) {
  auto colors = read_column<Rgb16>(first_record, header, [at = *header.format.color_at](const char* record) {
    const char* color = record + at;
    return Rgb16{load<std::uint16_t>(color), load<std::uint16_t>(color + 2), load<std::uint16_t>(color + 4)};
  });
  scale_colors(colors);
  return colors;
}

PointCloud read_points(const char* first_record, const LasHeader& header) {
  const LasPointFormat& format = header.format;
  PointCloud cloud;
  cloud.positions = read_positions(first_record, header);
  cloud.intensities = read_column<float>(first_record, header,
                                         [](const char* record) { return load<std::uint16_t>(record + kIntensityAt); });
  cloud.labels = read_column<std::uint16_t>(first_record, header, [&](const char* record) {
    return load<std::uint8_t>(record + format.classification_at) & format.classification_mask;
  });
  if (format.color_at) cloud.colors = read_colors(first_record, header);
  if (format.time_at) {
    cloud.times = read_column<double>(first_record, header,
                                      [&](const char* record) { return load<double>(record + *format.time_at); });
  }
  forget_if_all_zero(cloud.intensities);
  forget_if_all_zero(cloud.labels);
  forget_if_all_zero(cloud.colors);
  return cloud;
}

void refuse_compression(const std::filesystem::path& path, const std::vector<LasRecord>& records) {
  const auto is_laszip = [](const LasRecord& record) { return record.user == "laszip encoded"; };
  if (std::ranges::any_of(records, is_laszip)) {
    throw IoError::malformed(path,
                             "LAZ compression is not supported: decompress the file first (laszip, pdal translate)");
  }
}

// Places in the file.
std::vector<std::size_t> places_of_withheld(const char* first_record, const LasHeader& header) {
  std::vector<std::size_t> places;
  if (!header.has_flags) return places;
  const char* flags = first_record + header.format.withheld_at;
  for (std::uint64_t i = 0; i < header.num_points; ++i, flags += header.record_length) {
    if ((load<std::uint8_t>(flags) & header.format.withheld_mask) != 0) places.push_back(i);
  }
  return places;
}

// LAS 1.4-R15, table 9: such a point "should not be included in processing". Both lists of places rise.
void drop_withheld(const std::filesystem::path& path, const std::vector<std::size_t>& withheld, ReadResult& read) {
  std::vector<std::size_t> places;  // among those left
  std::size_t first = 0;            // in the file
  auto dropped = read.dropped.begin();
  for (const std::size_t place : withheld) {
    dropped = std::lower_bound(dropped, read.dropped.end(), place);
    const bool is_left = dropped == read.dropped.end() || *dropped != place;
    if (is_left && places.empty()) first = place;
    if (is_left) places.push_back(place - static_cast<std::size_t>(dropped - read.dropped.begin()));
  }
  if (places.empty()) return;
  if (places.size() == read.cloud.size()) throw IoError::malformed(path, "all of its points are withheld");
  drop_points(read, places, {"withheld points left out", places.size(), "point " + std::to_string(first + 1)});
}

}  // namespace

ReadResult read_las(const std::filesystem::path& path) {
  ByteReader file(path);
  LasHeader header = read_las_header(file);
  const LasRecords records = read_las_records(file, header);
  refuse_compression(path, records.records);
  const LasReferenceSystem system = find_reference_system(header, records.records);
  const LasPointCount count = count_las_points(file, header, records);
  header.num_points = count.num_points;

  file.seek(header.points_offset);
  const char* first_record = file.bytes(header.num_points * header.record_length).data();
  ReadResult result = finish_reading(path, read_points(first_record, header));
  for (const auto& findings : {header.findings, records.findings, system.findings, count.findings}) {
    result.findings.insert(result.findings.end(), findings.begin(), findings.end());
  }
  drop_withheld(path, places_of_withheld(first_record, header), result);
  result.epsg = system.epsg;
  if (!result.cloud.labels.empty()) result.label_scheme = LabelScheme::kAsprs;
  result.metres_per_unit = system.metres_per_unit.value_or(1.0);
  check_coordinates(path, result, system.kind);
  return result;
}

}  // namespace vdbmap
