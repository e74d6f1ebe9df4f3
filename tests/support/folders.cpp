// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/folders.h"

#include <cstdlib>
#include <string>

namespace vdbmap::test {

std::optional<std::filesystem::path> real_data_folder() {
  const char* chosen = std::getenv("VDBMAP_DATA");
  const std::filesystem::path folder = chosen ? chosen : VDBMAP_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return std::filesystem::canonical(folder);
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "vdbmap-test-XXXXXX").string();
  path_ = ::mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace vdbmap::test
