// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/vdb_checksum.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include <xxhash.h>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

// After 8 bytes magic number, 4 file version, 8 library version and 1 grid offsets comes the id.
constexpr std::size_t kIdBegin = 21;
constexpr std::size_t kIdSize = 36;
// An id that begins so is the checksum of the rest: "vdbmap" in ASCII codes.
constexpr std::string_view kIdPrefix = "7664626d-6170-";

std::ifstream open_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw IoError::system(path, "cannot open", errno);
  return stream;
}

std::string read_id(const std::filesystem::path& path) {
  std::ifstream stream = open_bytes(path);
  std::string id(kIdSize, '\0');
  stream.seekg(kIdBegin);
  stream.read(id.data(), kIdSize);
  return id;
}

// The id that belongs to the content of a file: its checksum without the id itself, in the form of a UUID.
std::string id_of_content(const std::filesystem::path& path) {
  std::ifstream stream = open_bytes(path);
  XXH3_state_t* state = XXH3_createState();
  XXH3_128bits_reset(state);
  std::array<char, 1 << 16> chunk;
  bool is_first = true;
  while (stream.read(chunk.data(), chunk.size()) || stream.gcount() > 0) {
    const auto size = static_cast<std::size_t>(stream.gcount());
    if (is_first && size >= kIdBegin + kIdSize) std::memset(chunk.data() + kIdBegin, 0, kIdSize);
    is_first = false;
    XXH3_128bits_update(state, chunk.data(), size);
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  XXH3_freeState(state);

  std::array<char, kIdSize + 1> id;
  std::snprintf(id.data(), id.size(), "%.*s%04x-%04x-%012llx", static_cast<int>(kIdPrefix.size()), kIdPrefix.data(),
                static_cast<unsigned>(hash.high64 >> 16 & 0xffff), static_cast<unsigned>(hash.high64 & 0xffff),
                static_cast<unsigned long long>(hash.low64 & 0xffffffffffff));
  return id.data();
}

}  // namespace

std::optional<std::string> stated_checksum(const std::filesystem::path& path) {
  std::string id = read_id(path);
  if (!id.starts_with(kIdPrefix)) return std::nullopt;
  id.erase(0, kIdPrefix.size());
  std::erase(id, '-');
  return id;
}

bool check_checksum(const std::filesystem::path& path) {
  const std::string id = read_id(path);
  if (!id.starts_with(kIdPrefix)) return false;
  if (id == id_of_content(path)) return true;
  throw IoError::malformed(path, "is damaged: its content does not match its checksum");
}

void write_checksum(const std::filesystem::path& path) {
  const std::string id = id_of_content(path);
  std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  stream.seekp(kIdBegin);
  stream.write(id.data(), kIdSize);
  stream.close();
}

}  // namespace vdbmap
