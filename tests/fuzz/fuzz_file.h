// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::fuzz {

/// The bytes as a file that lives in memory alone, until the next call.
inline std::filesystem::path file_of(const std::uint8_t* data, std::size_t size) {
  static const int descriptor = ::memfd_create("input", MFD_CLOEXEC);
  if (descriptor < 0 || ::ftruncate(descriptor, 0) != 0 ||
      ::pwrite(descriptor, data, size, 0) != static_cast<ssize_t>(size)) {
    std::abort();
  }
  return "/proc/self/fd/" + std::to_string(descriptor);
}

/// Reads the bytes as a file, on one thread, so that the same bytes take the same way again: that succeeds, or throws
/// an IoError. What else happens is a finding.
template <typename Read>
int read(const std::uint8_t* data, std::size_t size, const Read& read_file) {
  static const ThreadLimit one_thread(1);
  try {
    read_file(file_of(data, size));
  } catch (const IoError&) {
    return 0;
  }
  return 0;
}

}  // namespace vdbmap::fuzz
