// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

namespace vdbmap::test {

/// The folder of real recordings: $VDBMAP_DATA, else ../shared/data beside the source tree; nothing where neither is.
/// Tests that need it skip with a message.
std::optional<std::filesystem::path> real_data_folder();

/// What a test says that skips for want of them.
inline constexpr const char* kNeedsRealData = "needs the folder of real recordings ($VDBMAP_DATA)";

/// A folder of its own for one test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace vdbmap::test
