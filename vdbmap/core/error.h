// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace vdbmap {

/// A file that could not be used: what() is one line with the path, the place and the reason.
class IoError : public std::runtime_error {
 public:
  /// Why the file could not be used.
  enum class Kind {
    kMalformed,  ///< the content is not what it should be
    kSystem,     ///< the operating system refused: missing, no permission, disk full
  };

  /// The content is wrong as a whole: "scan.ply: reason".
  static IoError malformed(const std::filesystem::path& path, const std::string& reason);
  /// The content is wrong in a text line, counted from 1: "scan.ply:12: reason".
  static IoError malformed_at_line(const std::filesystem::path& path, std::uint64_t line, const std::string& reason);
  /// The content is wrong at a byte, counted from 0: "scan.ply: byte 120: reason".
  static IoError malformed_at_byte(const std::filesystem::path& path, std::uint64_t byte, const std::string& reason);
  /// The system call that failed left errno in `error_number`: "scan.ply: cannot open: No such file or directory".
  static IoError system(const std::filesystem::path& path, const std::string& action, int error_number);

  Kind kind() const { return kind_; }

 private:
  IoError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  Kind kind_;
};

}  // namespace vdbmap
