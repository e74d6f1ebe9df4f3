// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/points/point_collector.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/table/broken_points.h"
#include "vdbmap/io/table/missing_values.h"

namespace vdbmap {

/// What a word of a point stands for, in the texts of PLY and PCD.
struct WordColumn {
  std::string name;
  std::optional<PointField> field;  ///< nothing: passed over, whatever it is
  bool is_list = false;             ///< a length, and as many words behind it
  std::uint64_t num_words = 1;      ///< without a list; one where there is a field
};

/// Points that a header describes, as words: one on each line as a rule, several on a line where it holds whole ones,
/// and without regard to lines where these hold anything else. A line of a file of lines that holds no whole point is a
/// broken point.
class WordPoints {
 public:
  /// `noun` is what the format calls a column: "property", "field".
  WordPoints(std::vector<WordColumn> columns, std::string noun);

  /// Reads `count` points from the next line on, or as many as there are.
  void read(ByteReader& file, std::uint64_t count);

  std::uint64_t num_points() const { return collector_.size() + broken_.places().size(); }

  /// The points, and what is wrong with the others; `findings` come after. Throws IoError where more are broken than
  /// whole.
  ReadResult finish(const std::filesystem::path& path, const std::vector<ReadFinding>& findings);

 private:
  bool are_lines(ByteReader& file) const;
  void read_line(const ByteReader& file, std::string_view line, std::uint64_t most);
  void read_flow(ByteReader& file, std::uint64_t count);
  bool try_point(std::string_view& rest);
  bool try_column(std::size_t column, std::string_view& rest);
  bool skip_list(std::string_view& rest);
  bool skip_words(std::string_view& rest, std::uint64_t count);
  bool try_word(std::size_t column, std::string_view word);
  void finish_point(const ByteReader& file);
  void note_broken(const ByteReader& file);

  std::vector<WordColumn> columns_;
  std::string noun_;
  bool has_lists_ = false;
  std::uint64_t words_per_point_ = 0;  // without lists
  PointCollector collector_;
  // Of the point tried last: what is wrong with it, and what it lacks.
  std::size_t bad_column_ = 0;
  std::string_view bad_word_;  // empty: the line ended
  std::vector<std::pair<std::size_t, std::string_view>> lacking_;
  MissingValues missing_;
  BrokenPoints broken_;
};

}  // namespace vdbmap
