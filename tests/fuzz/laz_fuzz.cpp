// SPDX-License-Identifier: GPL-3.0-or-later
// A libFuzzer target: any bytes are read as a LAS or LAZ file, or refused with an IoError. Seeds: laz_seeds().
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/las/las.h"

namespace {

// A file that lives in memory alone.
std::string write_file(const std::uint8_t* data, std::size_t size) {
  static const int descriptor = ::memfd_create("laz", MFD_CLOEXEC);
  if (descriptor < 0 || ::ftruncate(descriptor, 0) != 0 ||
      ::pwrite(descriptor, data, size, 0) != static_cast<ssize_t>(size)) {
    std::abort();
  }
  return "/proc/self/fd/" + std::to_string(descriptor);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    vdbmap::read_las(write_file(data, size));
  } catch (const vdbmap::IoError&) {
    return 0;
  }
  return 0;
}
