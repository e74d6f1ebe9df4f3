// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/raw_files.h"

#include <fstream>
#include <sstream>
#include <utility>

namespace vdbmap::test {

std::string read_raw(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return std::move(bytes).str();
}

std::filesystem::path write_raw(const std::filesystem::path& path, std::string_view bytes) {
  // Truncating an existing file makes ext4 write it to disk at once, which takes milliseconds.
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

}  // namespace vdbmap::test
