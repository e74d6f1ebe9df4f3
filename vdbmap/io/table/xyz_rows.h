// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/points/point_collector.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/table/broken_points.h"
#include "vdbmap/io/table/missing_values.h"
#include "vdbmap/io/table/xyz_header.h"
#include "vdbmap/io/table/xyz_layout.h"
#include "vdbmap/io/table/xyz_preamble.h"

namespace vdbmap {

/// Turns the rows of a text table into points.
class XyzRows {
 public:
  /// `header`: the names on top, which may come again where files were joined. `count`: the count line on top; with it,
  /// others may follow, each before its own points.
  XyzRows(XyzLayout layout, const TableFormat& format, std::optional<XyzHeader> header, std::optional<CountLine> count);

  /// Takes the line that `file` read last. A line that is no row is a broken point, unless it is a comment, the header
  /// again or a count. Throws IoError for another header.
  void read(const ByteReader& file, std::string_view line);

  /// The points, and what is wrong with the others. Throws IoError where more are broken than whole.
  ReadResult finish(const std::filesystem::path& path);

 private:
  bool try_row(std::string_view row);
  void note_missing_values(std::uint64_t line, std::string_view row);
  void read_other_line(const ByteReader& file, std::string_view line, std::string_view row);
  std::string reason_of_broken(std::string_view row) const;
  void close_block();
  std::size_t num_points() const { return collector_.size() + broken_.places().size(); }

  XyzLayout layout_;
  TableFormat format_;
  std::optional<XyzHeader> header_;
  std::optional<CountLine> count_;
  std::size_t begin_of_block_ = 0;
  PointCollector collector_;
  bool lacks_value_ = false;  // the row tried last
  MissingValues missing_;
  BrokenPoints broken_;
  std::vector<ReadFinding> findings_;
};

}  // namespace vdbmap
