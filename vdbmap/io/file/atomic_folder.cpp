// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/atomic_folder.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/output_path.h"
#include "vdbmap/io/file/unfinished_paths.h"

namespace vdbmap {
namespace {

constexpr int kDeepest = 8;  // folders within folders

UnfinishedPaths<4> unfinished_folders;

// As the kernel lays it out; opendir() would allocate, which a signal handler must not.
struct DirectoryEntry {
  std::uint64_t inode;
  std::int64_t offset;
  std::uint16_t size;
  std::uint8_t type;
  char name[1];
};

void remove_content(int folder, int depth) noexcept;

void remove_entry(int folder, const char* name, int depth) noexcept {
  if (std::strcmp(name, ".") == 0 || std::strcmp(name, "..") == 0 || ::unlinkat(folder, name, 0) == 0) return;
  const int inner = ::openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (inner < 0) return;
  if (depth < kDeepest) remove_content(inner, depth + 1);
  ::close(inner);
  ::unlinkat(folder, name, AT_REMOVEDIR);
}

void remove_content(int folder, int depth) noexcept {
  alignas(DirectoryEntry) std::array<char, 2048> buffer;
  for (;;) {
    const long size = ::syscall(SYS_getdents64, folder, buffer.data(), buffer.size());
    if (size <= 0) return;
    for (long at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const DirectoryEntry*>(buffer.data() + at);
      remove_entry(folder, buffer.data() + at + offsetof(DirectoryEntry, name), depth);
      at += entry->size;
    }
  }
}

void remove_folder(const char* path) noexcept {
  // Other threads may still be writing: what they add in the meantime is removed too.
  for (int attempt = 0; attempt < 5; ++attempt) {
    const int folder = ::open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return;
    remove_content(folder, 0);
    ::close(folder);
    if (::rmdir(path) == 0) return;
  }
}

// As create_file_beside() of atomic_file.cpp.
std::filesystem::path create_folder_beside(const std::filesystem::path& target) {
  for (;;) {
    const std::filesystem::path temporary = temporary_name_beside(target);
    unfinished_folders.remember(temporary.string());
    if (::mkdir(temporary.c_str(), 0777) == 0) return temporary;
    const int reason = errno;
    unfinished_folders.forget(temporary.string());
    if (reason != EEXIST) throw IoError::system(target, "cannot create", reason);
  }
}

// "street/" and "street" are one folder, but only the latter has a name to put something beside.
std::filesystem::path without_trailing_slash(const std::filesystem::path& path) {
  const std::filesystem::path given = path.has_filename() ? path : path.parent_path();
  return std::filesystem::weakly_canonical(std::filesystem::absolute(follow_links(given)));
}

// Swaps two folders, so that there is always one of them at either place; where the file system cannot, one after the
// other.
bool exchange(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  const std::filesystem::path aside = temporary_name_beside(a);
  return ::rename(b.c_str(), aside.c_str()) == 0 && ::rename(a.c_str(), b.c_str()) == 0 &&
         ::rename(aside.c_str(), a.c_str()) == 0;
}

}  // namespace

AtomicFolder::AtomicFolder(const std::filesystem::path& target) : target_(without_trailing_slash(target)) {
  const std::filesystem::file_status status = status_of_target(target_);
  if (std::filesystem::exists(status) && !std::filesystem::is_directory(status)) {
    throw IoError::system(target, "cannot create the folder", ENOTDIR);
  }
  temporary_ = create_folder_beside(target_);
}

AtomicFolder::~AtomicFolder() {
  if (temporary_.empty()) return;
  remove_folder(temporary_.c_str());
  unfinished_folders.forget(temporary_.string());
}

void AtomicFolder::commit() {
  // Only where there is none, or an empty one; another process may be putting one there.
  const bool is_new = ::rename(temporary_.c_str(), target_.c_str()) == 0;
  const bool is_done = is_new || ((errno == ENOTEMPTY || errno == EEXIST) && exchange(temporary_, target_));
  if (!is_done) throw IoError::system(target_, "cannot replace", errno);
  if (!is_new) remove_folder(temporary_.c_str());
  unfinished_folders.forget(temporary_.string());
  temporary_.clear();
}

void remove_unfinished_folders() noexcept { unfinished_folders.for_each(remove_folder); }

}  // namespace vdbmap
