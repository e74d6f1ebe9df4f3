// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/error.h"

#include <system_error>

namespace vdbmap {

IoError IoError::malformed(const std::filesystem::path& path, const std::string& reason) {
  return {Kind::kMalformed, path.string() + ": " + reason};
}

IoError IoError::malformed_at_line(const std::filesystem::path& path, std::uint64_t line, const std::string& reason) {
  return {Kind::kMalformed, path.string() + ":" + std::to_string(line) + ": " + reason};
}

IoError IoError::malformed_at_byte(const std::filesystem::path& path, std::uint64_t byte, const std::string& reason) {
  return {Kind::kMalformed, path.string() + ": byte " + std::to_string(byte) + ": " + reason};
}

IoError IoError::system(const std::filesystem::path& path, const std::string& action, int error_number) {
  return {Kind::kSystem, path.string() + ": " + action + ": " + std::generic_category().message(error_number)};
}

}  // namespace vdbmap
