// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/las/las.h"
#include "vdbmap/io/las/las_columns.h"
#include "vdbmap/io/las/las_header.h"
#include "vdbmap/io/las/las_point_count.h"
#include "vdbmap/io/las/las_records.h"
#include "vdbmap/io/las/las_reference_system.h"
#include "vdbmap/io/laz/laszip_record.h"
#include "vdbmap/io/laz/laz_points.h"
#include "vdbmap/io/points/coordinate_kind.h"
#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

LasPoints read_las_points(ByteReader& file, const LasHeader& header, const LasRecords& records) {
  LasPointCount count = count_las_points(file, header, records);
  LasPoints points;
  file.seek(header.points_offset);
  const char* first_record = file.bytes(count.num_points * header.record_length).data();
  points.cloud = make_las_cloud(header, count.num_points);
  store_las_points(points.cloud, 0, first_record, count.num_points, header);
  finish_las_cloud(points.cloud);
  append_withheld(points.withheld, 0, first_record, count.num_points, header);
  points.findings = std::move(count.findings);
  return points;
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
  const LasHeader header = read_las_header(file);
  const LasRecords records = read_las_records(file, header);
  const LasReferenceSystem system = find_reference_system(header, records.records);
  const bool is_compressed = header.is_compressed || laz::is_compressed(records.records);
  LasPoints points =
      is_compressed ? laz::read_laz_points(file, header, records) : read_las_points(file, header, records);

  ReadResult result = finish_reading(path, std::move(points.cloud), points.lost);
  for (const auto& findings : {header.findings, records.findings, system.findings, points.findings}) {
    result.findings.insert(result.findings.end(), findings.begin(), findings.end());
  }
  drop_withheld(path, points.withheld, result);
  result.epsg = system.epsg;
  if (!result.cloud.labels.empty()) result.label_scheme = LabelScheme::kAsprs;
  result.metres_per_unit = system.metres_per_unit.value_or(1.0);
  check_coordinates(path, result, system.kind);
  return result;
}

}  // namespace vdbmap
