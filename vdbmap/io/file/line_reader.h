// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vdbmap {

/// Reads a text file, or a pipe, line by line: lines end with LF, CR LF or CR, and a UTF-8 byte order mark is passed
/// over. What is no text, like a device that never ends, takes no more memory than the longest line allowed.
class LineReader {
 public:
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;  ///< [bytes]

  /// Throws IoError where the file cannot be opened.
  explicit LineReader(std::filesystem::path path);

  /// The next line without its end, until the call after; nothing at the end of the file. Throws IoError where the
  /// file cannot be read, is text in UTF-16 or has a line that is too long.
  std::optional<std::string_view> next();

  /// Of the last line, from 1 on.
  std::uint64_t number() const { return number_; }

 private:
  int get();
  void begin();

  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<char> buffer_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;
  bool is_after_cr_ = false;
  std::string line_;
  std::uint64_t number_ = 0;
};

}  // namespace vdbmap
