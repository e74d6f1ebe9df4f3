// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/table_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr std::uint64_t kSampleSize = 4096;  // [bytes]
constexpr double kUnitTolerance = 1e-2;      // of vectors and quaternions that were written with few digits
constexpr std::size_t kNumRowsLookedAt = 3;  // a count may stand on top

// Words of file names that are no scans.
constexpr std::array<std::string_view, 27> kTableWords = {
    "annotations", "boxes",       "calib",    "calibration", "extrinsic",    "extrinsics", "gnss",
    "gps",         "groundtruth", "imu",      "intrinsic",   "intrinsics",   "labels",     "metadata",
    "navsat",      "odom",        "odometry", "oxts",        "poses",        "readme",     "times",
    "timestamps",  "tracklets",   "traj",     "trajectory",  "trajectories", "truth"};

// Names of columns that points do not have.
constexpr std::array<std::string_view, 22> kForeignColumns = {
    "qx",  "qy",        "qz", "qw", "roll", "pitch", "yaw", "heading", "lat",      "latitude", "lon",
    "lng", "longitude", "tx", "ty", "tz",   "vx",    "ax",  "wx",      "length_m", "width_m",  "track_uuid"};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

// The words between all that `is_part` is false for.
template <typename IsPart>
std::vector<std::string> words_of(std::string_view text, IsPart&& is_part) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (is_part(c)) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::vector<std::string> columns_of(std::string_view line) {
  return words_of(line, [](char c) { return c != ',' && c != ';' && c != '\t' && c != ' ' && c != '\r' && c != '"'; });
}

std::optional<std::vector<double>> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  for (const std::string& column : columns_of(line)) {
    const auto number = parse_number(column);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

bool is_unit(double a, double b, double c, double d = 0) {
  return std::abs(std::sqrt(a * a + b * b + c * c + d * d) - 1) < kUnitTolerance;
}

// The 3x4 matrix of KITTI: three rows of a rotation, each with a coordinate behind it.
bool is_matrix(const std::vector<double>& row) {
  if (row.size() != 12 && row.size() != 16) return false;
  return is_unit(row[0], row[1], row[2]) && is_unit(row[4], row[5], row[6]) && is_unit(row[8], row[9], row[10]);
}

// TUM: time, position, quaternion.
bool is_time_and_quaternion(const std::vector<double>& row) {
  return row.size() == 8 && is_unit(row[4], row[5], row[6], row[7]);
}

std::string reason_from_name(const std::filesystem::path& path) {
  for (const std::string& word : words_of(in_small_letters(path.stem().string()), is_letter)) {
    if (std::ranges::count(kTableWords, word) > 0) return "is named like a table of " + word;
  }
  return {};
}

// "P0: 7.2 0 ...", and names of columns.
std::string reason_from_names(const std::vector<std::string>& columns) {
  if (columns.front().ends_with(':')) return "holds " + vdbmap::quoted(columns.front()) + " and the like, no columns";
  for (const std::string& column : columns) {
    const std::string name = in_small_letters(column.substr(0, column.find_first_of("[(")));
    if (std::ranges::count(kForeignColumns, name) > 0) return "has a column " + name;
  }
  return {};
}

std::size_t count_numbers(const std::vector<std::string>& columns) {
  return static_cast<std::size_t>(
      std::ranges::count_if(columns, [](const std::string& column) { return parse_number(column).has_value(); }));
}

// The lines that are whole and not blank.
std::vector<std::string_view> filled_lines(std::string_view front) {
  std::vector<std::string_view> lines;
  for (std::size_t end = front.find('\n'); end != std::string_view::npos; end = front.find('\n')) {
    const std::string_view line = front.substr(0, end);
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) lines.push_back(line);
    front.remove_prefix(end + 1);
  }
  return lines;
}

std::string reason_from_content(std::string_view front) {
  std::vector<std::vector<double>> rows;  // of numbers alone
  std::size_t most_numbers = 0;
  for (std::string_view line : filled_lines(front)) {
    line.remove_prefix(std::min(line.find_first_not_of("#/% \t\xef\xbb\xbf"), line.size()));
    const std::vector<std::string> columns = columns_of(line);
    if (columns.empty()) continue;
    most_numbers = std::max(most_numbers, count_numbers(columns));
    if (const auto numbers = numbers_of(line)) {
      rows.push_back(*numbers);
    } else if (std::string reason = reason_from_names(columns); !reason.empty()) {
      return reason;
    }
    if (rows.size() == kNumRowsLookedAt) break;
  }
  if (!rows.empty() && (std::ranges::all_of(rows, is_matrix) || std::ranges::all_of(rows, is_time_and_quaternion))) {
    return "holds poses";
  }
  return !front.empty() && most_numbers < 3 ? "holds no rows of three numbers" : "";
}

}  // namespace

std::string reason_no_scan(const std::filesystem::path& table) {
  if (std::string reason = reason_from_name(table); !reason.empty()) return reason;
  try {
    const std::string front = read_front(table, kSampleSize);
    return reason_from_content(front.empty() || front.size() == kSampleSize ? front : front + "\n");
  } catch (const IoError&) {
    return {};  // reading it will say why
  }
}

}  // namespace vdbmap
