// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/atomic_file.h"

#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/output_path.h"
#include "vdbmap/io/file/unfinished_paths.h"

namespace vdbmap {
namespace {

constexpr std::size_t kBufferSize = 1 << 20;  // [bytes]

UnfinishedPaths<16> unfinished_files;

// With the permissions that the kernel gives by the user's umask, which no process can ask for without setting it, for
// all its threads. The name is remembered first, so that no signal finds a file that is not.
int create_file_beside(const std::filesystem::path& target, std::filesystem::path& temporary) {
  for (;;) {
    temporary = temporary_name_beside(target);
    unfinished_files.remember(temporary.string());
    const int descriptor = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return descriptor;
    const int reason = errno;
    unfinished_files.forget(temporary.string());
    if (reason != EEXIST) throw IoError::system(target, "cannot create", reason);
  }
}

// A rename would put a file in the place of a device or pipe.
void check_replaceable(const std::filesystem::path& target) {
  const std::filesystem::file_status status = status_of_target(target);
  if (std::filesystem::is_directory(status)) throw IoError::system(target, "cannot create", EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError::system(target, "cannot replace what is no regular file", EINVAL);
  }
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(follow_links(target)) {
  check_replaceable(target_);
  descriptor_ = create_file_beside(target_, temporary_);
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

void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) throw IoError::system(folder, "cannot open", errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (error != 0 && error != EINVAL)
    throw IoError::system(folder, "cannot write", error);  // EINVAL: no such thing here
}

void check_writable(const std::filesystem::path& target) { AtomicFile probe(target); }

void remove_unfinished_files() noexcept {
  unfinished_files.for_each([](const char* path) { ::unlink(path); });
}

}  // namespace vdbmap
