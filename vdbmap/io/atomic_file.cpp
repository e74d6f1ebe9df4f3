// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/atomic_file.h"

#include <cerrno>
#include <cstdlib>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/unfinished_paths.h"

namespace vdbmap {
namespace {

constexpr std::size_t kBufferSize = 1 << 20;  // [bytes]

UnfinishedPaths<16> unfinished_files;

int create_file_beside(const std::filesystem::path& target, std::filesystem::path& temporary) {
  std::string name = target.string() + ".XXXXXX";
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) throw IoError::system(target, "cannot create", errno);
  temporary = name;

  const mode_t mask = ::umask(0);  // mkstemp gives 0600; a finished file follows the user's umask
  ::umask(mask);
  ::fchmod(descriptor, 0666 & ~mask);
  return descriptor;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
  if (std::filesystem::is_directory(target_)) throw IoError::system(target_, "cannot create", EISDIR);
  // A rename would put a file in the place of a device or pipe.
  if (std::filesystem::exists(target_) && !std::filesystem::is_regular_file(target_)) {
    throw IoError::system(target_, "cannot replace what is no regular file", EINVAL);
  }
  descriptor_ = create_file_beside(target_, temporary_);
  unfinished_files.remember(temporary_.string());
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
  unfinished_files.forget(temporary_.string());
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferSize) flush();
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw IoError::system(target_, "cannot write", errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0) throw IoError::system(target_, "cannot write", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) throw IoError::system(target_, "cannot replace", errno);
  ::close(descriptor_);
  descriptor_ = -1;
  unfinished_files.forget(temporary_.string());
}

void write_file(const std::filesystem::path& target, std::string_view bytes) {
  AtomicFile file(target);
  file.write(bytes);
  file.commit();
}

void check_writable(const std::filesystem::path& target) { AtomicFile probe(target); }

void remove_unfinished_files() noexcept {
  unfinished_files.for_each([](const char* path) { ::unlink(path); });
}

}  // namespace vdbmap
