// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "vdbmap/io/file/atomic_folder.h"

namespace vdbmap {

/// Name of the file that makes a folder a site, and says all about it.
inline constexpr const char* kSiteFile = "site.json";

/// Whether a folder is a site that we wrote.
bool is_site(const std::filesystem::path& folder);

/// Throws IoError (malformed) where a folder holds something, but no site of ours.
void check_site_folder(const std::filesystem::path& folder);

/// The folder of a site while it is written: it appears whole, in the place of the site that was there. Files named by
/// their content that the former site has are taken over from it, not written again. Threads may put files at once.
class SiteFolder {
 public:
  /// Throws IoError as check_site_folder(), and where the folder cannot be written.
  explicit SiteFolder(const std::filesystem::path& folder);

  /// Writes a file; `name` may have folders in it. Throws IoError (system).
  void put(const std::string& name, std::string_view bytes) const;

  /// Writes a file named by its content, and returns its name: "0_1_2" and ".glb" become "0_1_2.HASH.glb" in the
  /// folder.
  std::string put_content(const std::string& folder, const std::string& stem, const char* ending,
                          std::string_view bytes);

  /// Copies a folder of files into the site. Throws IoError.
  void put_folder(const std::filesystem::path& folder) const;

  std::size_t num_written() const { return num_written_; }  ///< by put_content()
  std::size_t num_kept() const { return num_kept_; }        ///< of the former site

  /// Makes it the site. Throws IoError (system).
  void commit() { folder_.commit(); }

 private:
  bool take_over(const std::string& name) const;

  std::filesystem::path former_;
  AtomicFolder folder_;
  std::atomic<std::size_t> num_written_ = 0;
  std::atomic<std::size_t> num_kept_ = 0;
};

}  // namespace vdbmap
