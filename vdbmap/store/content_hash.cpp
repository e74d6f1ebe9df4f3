// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/content_hash.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <vector>

#include <fcntl.h>
#include <unistd.h>
#include <xxhash.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {

ContentHash::ContentHash() : state_(XXH3_createState()) { XXH3_128bits_reset(state_); }
ContentHash::~ContentHash() { XXH3_freeState(state_); }

void ContentHash::add(const void* bytes, std::size_t size) { XXH3_128bits_update(state_, bytes, size); }

std::string ContentHash::digits() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_);
  std::array<char, kNumDigits + 1> text;
  std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text.data();
}

std::string hash_of_bytes(std::string_view bytes) {
  ContentHash hash;
  hash.add(bytes.data(), bytes.size());
  return hash.digits();
}

std::string hash_of_file(const std::filesystem::path& path) {
  check_regular_file(path);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw IoError::system(path, "cannot open", errno);
  ContentHash hash;
  std::vector<char> chunk(std::size_t{1} << 20);
  ssize_t size = 0;
  while ((size = ::read(descriptor, chunk.data(), chunk.size())) > 0 || (size < 0 && errno == EINTR)) {
    if (size > 0) hash.add(chunk.data(), static_cast<std::size_t>(size));
  }
  const int error = size < 0 ? errno : 0;
  ::close(descriptor);
  if (error != 0) throw IoError::system(path, "cannot read", error);
  return hash.digits();
}

}  // namespace vdbmap
