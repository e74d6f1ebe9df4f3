// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace vdbmap::cli {

/// A file of a site that is open for reading. Threads may read at once.
class ServedFile {
 public:
  /// Opens the file of an address's path, which begins with '/' and is decoded: "/" and "/a/" stand for the index.html
  /// there. Nothing where it is no regular file beneath the folder: the path leads out of it ("..") or through a
  /// symbolic link, a name in it begins with a dot, or it cannot be read.
  static std::optional<ServedFile> open(const std::filesystem::path& folder, const std::string& path);

  const std::string& path() const { return path_; }  ///< with index.html, where that is meant
  std::uint64_t size() const { return size_; }       ///< [bytes]
  const std::string& tag() const { return tag_; }    ///< of this state of the file, without quotes

  /// Reads up to `count` bytes from `offset` on; fewer at the end of the file, or where it cannot be read.
  std::size_t read(std::uint64_t offset, char* bytes, std::size_t count) const;

 private:
  ServedFile(int descriptor, std::string path);

  std::shared_ptr<const int> descriptor_;
  std::string path_;
  std::uint64_t size_ = 0;
  std::string tag_;
  bool is_regular_ = false;
};

/// The type of a file by its ending: "text/html; charset=utf-8"; "application/octet-stream" for others.
std::string media_type(const std::string& path);

/// Whether files of that ending become smaller by compression: text does, tiles are compressed already.
bool is_compressible(const std::string& path);

/// Whether a file's name has a hash of its content in it, so that it can be kept for ever: those of tiles, details and
/// assets.
bool is_named_by_content(const std::string& path);

}  // namespace vdbmap::cli
