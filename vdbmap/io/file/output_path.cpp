// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/output_path.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <random>
#include <string>
#include <system_error>

#include <unistd.h>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr int kMostLinks = 40;  // as Linux follows
constexpr std::size_t kNumLetters = 8;

std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::uniform_int_distribution<std::size_t> choose(0, kLetters.size() - 1);
  std::string letters(kNumLetters, '\0');
  std::ranges::generate(letters, [&] { return kLetters[choose(random)]; });
  return letters;
}

// [bytes] of a name in the folder, which may be "".
std::size_t longest_name(const std::filesystem::path& folder) {
  const long limit = ::pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  const std::size_t longest = limit > 0 ? static_cast<std::size_t>(limit) : NAME_MAX;
  const std::size_t taken = folder.native().size() + 2;  // the slash and the zero at the end
  return std::min(longest, taken < PATH_MAX ? PATH_MAX - taken : 0);
}

// Not in the middle of a character: some file systems refuse names that are no UTF-8.
std::string shortened(std::string name, std::size_t size) {
  if (name.size() <= size) return name;
  const auto continues_character = [&](std::size_t at) {
    return (static_cast<unsigned char>(name[at]) & 0xc0) == 0x80;
  };
  while (size > 0 && continues_character(size)) --size;
  name.resize(size);
  return name;
}

}  // namespace

std::filesystem::path follow_links(const std::filesystem::path& target) {
  std::filesystem::path path = target;
  std::error_code error;
  for (int i = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(path, error)); ++i) {
    if (i == kMostLinks) throw IoError::system(target, "cannot create", ELOOP);
    const std::filesystem::path folder =
        std::filesystem::canonical(path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), error);
    const bool is_open_file = folder.native().starts_with("/proc/");
    if (is_open_file) throw IoError::system(target, "cannot replace what is no regular file", EINVAL);
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) throw IoError::system(target, "cannot create", error.value());
    path = path.parent_path() / next;  // an absolute one replaces all of it
  }
  return path;
}

std::filesystem::file_status status_of_target(const std::filesystem::path& target) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(target, error);
  if (status.type() == std::filesystem::file_type::none) throw IoError::system(target, "cannot create", error.value());
  return status;
}

std::filesystem::path temporary_name_beside(const std::filesystem::path& target) {
  const std::filesystem::path folder = target.parent_path();
  const std::string ending = std::string(1, '.').append(random_letters());
  const std::size_t longest = longest_name(folder);
  const std::size_t left = longest > ending.size() ? longest - ending.size() : 0;
  return folder / (shortened(target.filename().string(), left) + ending);
}

}  // namespace vdbmap
