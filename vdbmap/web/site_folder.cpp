// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_folder.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <system_error>

#include <nlohmann/json.hpp>
#include <xxhash.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

constexpr std::uint64_t kMostSiteBytes = std::uint64_t{64} << 20;

// 16 hexadecimal digits.
std::string hash_of(std::string_view bytes) {
  std::array<char, 17> text;
  std::snprintf(text.data(), text.size(), "%016llx",
                static_cast<unsigned long long>(XXH3_64bits(bytes.data(), bytes.size())));
  return text.data();
}

void write_plain(const std::filesystem::path& path, std::string_view bytes) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw IoError::system(path, "cannot write", errno != 0 ? errno : EIO);
}

}  // namespace

bool is_site(const std::filesystem::path& folder) {
  std::error_code missing;
  const std::filesystem::path file = folder / kSiteFile;
  if (!std::filesystem::is_regular_file(file, missing)) return false;
  const auto json = nlohmann::json::parse(read_front(file, kMostSiteBytes), nullptr, false);
  return json.is_object() && json.contains("format") && json["format"] == "vdbmap-site";
}

void check_site_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error) || std::filesystem::is_empty(folder, error)) return;
  if (!is_site(folder)) {
    throw IoError::malformed(folder, "holds something else, expected a new folder or a site that vdbmap made");
  }
}

SiteFolder::SiteFolder(const std::filesystem::path& folder)
    : former_((check_site_folder(folder), folder)), folder_(folder) {}

void SiteFolder::put(const std::string& name, std::string_view bytes) const {
  const std::filesystem::path path = folder_.temporary_path() / name;
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  if (error) throw IoError::system(path.parent_path(), "cannot create the folder", error.value());
  write_plain(path, bytes);
}

std::string SiteFolder::put_content(const std::string& folder, const std::string& stem, const char* ending,
                                    std::string_view bytes) {
  const std::string name = stem + "." + hash_of(bytes) + ending;
  const std::string path = folder + "/" + name;
  if (take_over(path)) {
    ++num_kept_;
  } else {
    put(path, bytes);
    ++num_written_;
  }
  return name;
}

// A second name of the same file: nothing is copied, its time stays.
bool SiteFolder::take_over(const std::string& name) const {
  const std::filesystem::path to = folder_.temporary_path() / name;
  std::error_code error;
  if (std::filesystem::exists(to, error)) return true;  // of another epoch
  if (!std::filesystem::exists(former_ / name, error)) return false;
  std::filesystem::create_directories(to.parent_path(), error);
  std::filesystem::create_hard_link(former_ / name, to, error);
  return !error;
}

void SiteFolder::put_folder(const std::filesystem::path& folder) const {
  try {
    std::filesystem::copy(folder, folder_.temporary_path(), std::filesystem::copy_options::recursive);
  } catch (const std::filesystem::filesystem_error& error) {
    throw IoError::system(folder, "cannot copy", error.code().value());
  }
}

}  // namespace vdbmap
