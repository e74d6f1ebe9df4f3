// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/points/point_cloud_filter.h"
#include "vdbmap/io/table/table_sample.h"
#include "vdbmap/io/table/xyz.h"
#include "vdbmap/io/table/xyz_preamble.h"
#include "vdbmap/io/table/xyz_rows.h"

namespace vdbmap {
namespace {

std::uint64_t line_number(const ByteReader& file, std::string_view place) {
  const std::string_view all = file.all();
  return 1 + static_cast<std::uint64_t>(std::count(all.data(), place.data(), line_end_of(all)));
}

void refuse_doubtful_comma(const ByteReader& file, const TableSample& sample) {
  const std::optional<TableDoubt> doubt = find_doubtful_comma(sample);
  if (!doubt) return;
  throw IoError::malformed_at_line(file.path(), line_number(file, doubt->line),
                                   quoted(doubt->line) + " " + doubt->reason + "; write decimal points");
}

// Why there is no row at all.
ReadResult refuse_without_rows(ByteReader& file) {
  file.seek(0);
  const XyzPreamble preamble = read_preamble(file, {}, 0);
  constexpr const char* kNumbers =
      "no line holds three numbers, parted by blanks, commas, semicolons or tabs and without marks between thousands";
  if (preamble.first_row) file.fail_line(kNumbers);
  if (preamble.text) throw IoError::malformed_at_line(file.path(), preamble.text->line, kNumbers);
  return finish_reading(file.path(), {});
}

bool fits(std::size_t num_names, const TableSample& sample) {
  return num_names == sample.num_columns || (num_names == sample.num_columns + 1 && sample.has_empty_last_column);
}

std::string text_of_counts(std::size_t num_names, const TableSample& sample) {
  return std::to_string(num_names) + " names for " + std::to_string(sample.num_columns) + " columns";
}

[[noreturn]] void fail_at(const ByteReader& file, const XyzHeader& header, const std::string& reason) {
  throw IoError::malformed_at_line(file.path(), header.line, reason);
}

XyzLayout layout_of_given(const ByteReader& file, const std::vector<std::string>& columns, const TableSample& sample) {
  if (!fits(columns.size(), sample)) file.fail_line("--columns has " + text_of_counts(columns.size(), sample));
  return layout_of_names(columns, sample);
}

// A header decides even where it cannot be right: what it says is not overruled by the number of columns.
std::optional<XyzLayout> layout_of_header(const ByteReader& file, const XyzPreamble& preamble,
                                          const TableSample& sample) {
  const std::optional<XyzHeader>& header = preamble.header;
  if (!header || (header->is_comment && header->is_sentence() && !fits(header->names.size(), sample))) {
    return std::nullopt;
  }
  if (!fits(header->names.size(), sample)) {
    fail_at(file, *header, "the header has " + text_of_counts(header->names.size(), sample));
  }
  XyzLayout layout = layout_of_names(header->names, sample);
  leave_out_times_of_no_unit(layout, sample);
  return layout;
}

XyzLayout choose_layout(const ByteReader& file, const XyzPreamble& preamble, const TableSample& sample,
                        const std::vector<std::string>& columns) {
  if (!columns.empty()) return layout_of_given(file, columns, sample);
  if (const auto layout = layout_of_header(file, preamble, sample)) return *layout;
  if (preamble.text && fits(preamble.text->names.size(), sample)) {
    const std::string advice = preamble.text->names_angles() ? "project latitude and longitude to metres first"
                                                             : "say with --columns what the columns are";
    fail_at(file, *preamble.text, "a header without x, y and z; " + advice);
  }
  if (may_be_halves_of_numbers(sample)) {
    file.fail_line("its commas may part columns or decimals; write decimal points, or name the columns");
  }
  const bool is_leica = lower_case(file.path().extension().string()) == ".pts";
  if (const auto layout = layout_of_values(sample, is_leica)) return *layout;
  file.fail_line("found " + std::to_string(sample.num_columns) +
                 " columns, and neither a header nor their numbers say what they are; name them, as in --columns "
                 "x,y,z,r,g,b,-");
}

}  // namespace

ReadResult read_xyz(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  check_columns(columns);
  ByteReader file(path);
  refuse_foreign_text(file);
  const std::optional<TableSample> sample = take_sample(without_byte_order_mark(file.all()));
  if (!sample) return refuse_without_rows(file);
  refuse_doubtful_comma(file, *sample);

  const XyzPreamble preamble = read_preamble(file, sample->format, sample->num_columns);
  if (!preamble.first_row) return refuse_without_rows(file);
  XyzRows rows(choose_layout(file, preamble, *sample, columns), sample->format, preamble.header, preamble.count);
  rows.read(file, *preamble.first_row);
  while (file.remaining() > 0) rows.read(file, file.read_line());
  ReadResult result = rows.finish(path);
  result.findings.insert(result.findings.begin(), preamble.findings.begin(), preamble.findings.end());
  return result;
}

}  // namespace vdbmap
