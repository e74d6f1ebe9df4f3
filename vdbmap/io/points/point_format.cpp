// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/point_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string>
#include <string_view>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr std::uint64_t kFrontSize = 4096;  // [bytes]

bool is_packet_capture(std::string_view front) {
  // pcap with microseconds and nanoseconds, both byte orders, and pcapng.
  constexpr std::array<std::string_view, 5> kMagics = {"\xd4\xc3\xb2\xa1", "\xa1\xb2\xc3\xd4", "\x4d\x3c\xb2\xa1",
                                                       "\xa1\xb2\x3c\x4d", "\x0a\x0d\x0d\x0a"};
  return std::ranges::any_of(kMagics, [front](std::string_view magic) { return front.starts_with(magic); });
}

// The first line that is neither blank nor a comment; empty where there is none.
std::string_view first_data_line(std::string_view front) {
  while (!front.empty()) {
    const std::string_view line = front.substr(0, front.find('\n'));
    std::string_view rest = line;
    const std::string_view word = next_word(rest);
    if (!word.empty() && !word.starts_with('#') && !word.starts_with("//")) return line;
    front.remove_prefix(std::min(line.size() + 1, front.size()));
  }
  return {};
}

bool is_ply_header(std::string_view front) {
  const bool is_ply = lower_case(front.substr(0, 3)) == "ply" && front.size() > 3;
  return is_ply && std::string_view(" \t\r\n").find(front[3]) != std::string_view::npos;
}

// Keywords in small letters begin other texts too: the last line of the header must be there.
bool is_pcd_header(std::string_view front) {
  std::string_view line = first_data_line(front);
  const std::string_view keyword = next_word(line);
  if (front.starts_with("# .PCD") || keyword == ".PCD" || keyword == "VERSION" || keyword == "FIELDS") return true;
  const std::string lower = lower_case(keyword);
  const bool is_keyword = lower == "version" || lower == "fields" || lower == "columns";
  return is_keyword && lower_case(front).find("\ndata ") != std::string::npos;
}

std::optional<PointFormat> format_of_magic(std::string_view front) {
  if (is_ply_header(front)) return PointFormat::kPly;
  if (front.starts_with("LASF")) return PointFormat::kLas;
  if (is_packet_capture(front)) return PointFormat::kVlp16Pcap;
  if (is_pcd_header(front)) return PointFormat::kPcd;
  return std::nullopt;
}

bool is_text(std::string_view front) {
  return std::ranges::all_of(front, [](char c) {
    const bool is_utf8 = static_cast<unsigned char>(c) >= 0x80;
    return is_utf8 || (c >= ' ' && c <= '~') || (c >= '\t' && c <= '\r');
  });
}

// ASCII only: a few binary numbers may pass for UTF-8, but hardly for this.
bool begins_with_number(std::string_view line) {
  const bool is_ascii = std::ranges::all_of(line, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  const std::string_view column = line.substr(0, line.find_first_of(",;"));
  std::string_view rest = column;
  return is_ascii && parse_number(next_word(rest)).has_value();
}

}  // namespace

std::optional<PointFormat> format_of_extension(const std::filesystem::path& path) {
  static const std::map<std::string_view, PointFormat> kFormats = {
      {".ply", PointFormat::kPly},          {".pcd", PointFormat::kPcd},      {".las", PointFormat::kLas},
      {".laz", PointFormat::kLas},          {".bin", PointFormat::kKittiBin}, {".xyz", PointFormat::kXyz},
      {".csv", PointFormat::kXyz},          {".asc", PointFormat::kXyz},      {".txt", PointFormat::kXyz},
      {".pts", PointFormat::kXyz},          {".ptx", PointFormat::kXyz},      {".pcap", PointFormat::kVlp16Pcap},
      {".pcapng", PointFormat::kVlp16Pcap},
  };
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto found = kFormats.find(extension);
  return found == kFormats.end() ? std::nullopt : std::optional(found->second);
}

PointFormat detect_point_format(const std::filesystem::path& path) {
  const std::string bytes = read_front(path, kFrontSize);
  const std::string_view front = without_byte_order_mark(bytes);
  if (bytes.empty()) throw IoError::malformed(path, "the file is empty");
  if (const auto format = format_of_magic(front)) return *format;
  if (is_text(front) && begins_with_number(first_data_line(front))) return PointFormat::kXyz;
  if (const auto format = format_of_extension(path)) return *format;
  if (is_text(front)) return PointFormat::kXyz;
  throw IoError::malformed(path, "not a point file, expected PLY, PCD, LAS, LAZ, KITTI .bin, XYZ, CSV or VLP-16 .pcap");
}

}  // namespace vdbmap
