// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vdbmap {

/// A file that appears whole or not at all: written beside its target under a temporary name, flushed to disk, then
/// renamed over it. Destruction without commit() removes the temporary file and leaves the target as it was. Where the
/// target is a symbolic link, the link stays and what it points to is replaced.
class AtomicFile {
 public:
  /// Creates the temporary file, with the permissions of the user's umask. Throws IoError (system) where the folder
  /// cannot be written, or the target is a folder, a pipe or a device.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write before commit(); exists and is empty at first.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Appends through a buffer of the file's own. Throws IoError (system), for example when the disk is full.
  void write(std::string_view bytes);

  /// Flushes to disk and renames. Throws IoError (system).
  void commit();

 private:
  void flush();

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes a whole file atomically.
void write_file(const std::filesystem::path& target, std::string_view bytes);

/// Flushes a folder to disk: the names in it, as fsync of a file does not. Throws IoError (system).
void sync_folder(const std::filesystem::path& folder);

/// Throws IoError (system) unless a file could be created at `target`: call it before hours of work.
void check_writable(const std::filesystem::path& target);

/// Removes the temporary files of all unfinished AtomicFiles; safe inside a signal handler.
void remove_unfinished_files() noexcept;

}  // namespace vdbmap
