// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace vdbmap {

/// A folder that appears whole or not at all: filled beside its target under a temporary name, then renamed over it.
/// Destruction without commit() removes what was filled and leaves the target as it was.
class AtomicFolder {
 public:
  /// Creates the temporary folder. Throws IoError (system) where the folder above cannot be written, or the target is
  /// no folder.
  explicit AtomicFolder(const std::filesystem::path& target);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  /// Where to put files before commit(); exists and is empty at first.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Takes the place of the target; a folder that was there is removed. Throws IoError (system).
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

/// Removes all unfinished AtomicFolders with what is in them; safe inside a signal handler.
void remove_unfinished_folders() noexcept;

}  // namespace vdbmap
