// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_lock.h"

#include <array>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr std::size_t kMostHolderBytes = 256;  // a process, a host and the words between

// "process 4711 on host".
std::string this_process() {
  std::array<char, HOST_NAME_MAX + 1> host{};
  ::gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(::getpid()) + " on " + host.data();
}

// What the holder wrote; it may not have come to it yet.
std::string read_holder(int descriptor) {
  std::array<char, kMostHolderBytes> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : "another process";
}

int lock_nonblocking(int descriptor) {
  int result = 0;
  do {
    result = ::flock(descriptor, LOCK_EX | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  return result == 0 ? 0 : errno;
}

// Returns 0 or the error.
int write_holder(int descriptor) {
  const std::string holder = this_process();
  if (::ftruncate(descriptor, 0) != 0) return errno;
  const ssize_t written = ::pwrite(descriptor, holder.data(), holder.size(), 0);
  if (written < 0) return errno;
  return static_cast<std::size_t>(written) == holder.size() ? 0 : ENOSPC;
}

}  // namespace

CityLock::CityLock(const std::filesystem::path& city) {
  const std::filesystem::path file = city / "lock";
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor_ < 0) throw IoError::system(city, "cannot be written", errno);

  int error = lock_nonblocking(descriptor_);
  std::string reason = error == EWOULDBLOCK ? read_holder(descriptor_) + " is writing it" : "cannot be locked";
  if (error == 0) {
    error = write_holder(descriptor_);
    reason = "cannot be written";
  }
  if (error == 0) return;
  ::close(descriptor_);
  throw IoError::system(city, reason, error);
}

CityLock::~CityLock() { ::close(descriptor_); }

}  // namespace vdbmap
