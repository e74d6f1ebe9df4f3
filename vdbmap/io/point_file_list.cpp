// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>

#include "vdbmap/core/error.h"
#include "vdbmap/io/point_format.h"
#include "vdbmap/io/point_reader.h"

namespace vdbmap {
namespace {

using Path = std::filesystem::path;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Cuts the digits off the front of `rest`, without leading zeros.
std::string_view cut_number(std::string_view& rest) {
  const std::size_t length = std::min(rest.find_first_not_of("0123456789"), rest.size());
  std::string_view digits = rest.substr(0, length);
  rest.remove_prefix(length);
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

// Negative, zero or positive as `a` comes before, with or after `b`.
int compare_naturally(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view number_a = cut_number(a);
      const std::string_view number_b = cut_number(b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size() ? -1 : 1;
      if (const int order = number_a.compare(number_b); order != 0) return order;
    } else {
      if (a.front() != b.front()) return a.front() < b.front() ? -1 : 1;
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return static_cast<int>(b.empty()) - static_cast<int>(a.empty());
}

bool comes_before(const Path& a, const Path& b) {
  const int order = compare_naturally(a.filename().string(), b.filename().string());
  return order != 0 ? order < 0 : a < b;  // scan_1 and scan_01 need an order too
}

// Text may be anything in a folder of scans (poses, times), and a dot hides what is not meant.
bool is_listed(const std::filesystem::directory_entry& entry) {
  const Path& path = entry.path();
  std::error_code ignored;
  return entry.is_regular_file(ignored) && !path.filename().string().starts_with('.') && path.extension() != ".txt" &&
         format_of_extension(path).has_value();
}

std::vector<Path> list_folder(const Path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  std::vector<Path> files;
  for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error)) {
    if (is_listed(*entries)) files.push_back(entries->path());
  }
  if (error) throw IoError::system(folder, "cannot list", error.value());
  if (files.empty()) {
    throw IoError::malformed(folder, "the folder holds no point files (.ply .pcd .las .bin .xyz .csv .asc .pcap)");
  }
  std::ranges::sort(files, comes_before);
  return files;
}

}  // namespace

std::vector<Path> list_point_files(const std::vector<Path>& inputs) {
  std::vector<Path> files;
  for (const Path& input : inputs) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(input, error);
    if (!std::filesystem::exists(status)) throw IoError::system(input, "cannot open", error.value());
    if (!std::filesystem::is_directory(status)) {
      files.push_back(input);
      continue;
    }
    for (const Path& file : list_folder(input)) files.push_back(file);
  }
  return files;
}

}  // namespace vdbmap
