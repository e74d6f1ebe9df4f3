// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include <xxhash.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/atomic_file.h"

namespace vdbmap {
namespace {

// Header of a .vdb file: 8 bytes magic number, 4 file version, 8 library version, 1 grid offsets, then the id.
constexpr std::size_t kIdBegin = 21;
constexpr std::size_t kIdSize = 36;
constexpr std::string_view kMagic(" BDV\0\0\0\0", 8);
// An id that begins so is the checksum of the rest: "vdbmap" in ASCII codes.
constexpr std::string_view kIdPrefix = "7664626d-6170-";

// What the first bytes of a file say.
struct Header {
  bool is_vdb = false;
  std::string id;
};

std::ifstream open_for_reading(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw IoError::system(path, "cannot read", EISDIR);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw IoError::system(path, "cannot open", errno);
  return stream;
}

Header read_header(const std::filesystem::path& path) {
  std::ifstream stream = open_for_reading(path);
  std::string bytes(kIdBegin + kIdSize, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));

  Header header;
  header.is_vdb = std::string_view(bytes).substr(0, kMagic.size()) == kMagic;
  if (bytes.size() == kIdBegin + kIdSize) header.id = bytes.substr(kIdBegin);
  return header;
}

// The id that belongs to the content of a file: its checksum without the id itself, in the form of a UUID.
std::string id_of_content(const std::filesystem::path& path) {
  std::ifstream stream = open_for_reading(path);
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

void replace_id(const std::filesystem::path& path) {
  const std::string id = id_of_content(path);
  std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(kIdBegin);
  stream.write(id.data(), static_cast<std::streamsize>(id.size()));
  if (!stream.flush()) throw IoError::system(path, "cannot write", errno);
}

void check_content(const std::filesystem::path& path) {
  const Header header = read_header(path);
  if (!header.is_vdb) throw IoError::malformed(path, "is not an OpenVDB file");
  if (header.id.starts_with(kIdPrefix) && header.id != id_of_content(path)) {
    throw IoError::malformed(path, "is damaged: its content does not match its checksum");
  }
}

}  // namespace

VdbContent read_vdb(const std::filesystem::path& path) {
  check_content(path);
  openvdb::initialize();
  try {
    openvdb::io::File file(path.string());
    file.open(/*delayLoad=*/false);
    VdbContent content;
    content.grids = *file.getGrids();
    content.metadata = file.getMetadata();
    return content;
  } catch (const openvdb::Exception& error) {
    throw IoError::malformed(path, std::string("cannot be read as OpenVDB: ") + error.what());
  }
}

void write_vdb(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) {
  openvdb::initialize();
  AtomicFile target(path);
  try {
    openvdb::io::File file(target.temporary_path().string());
    file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
    file.write(grids, metadata);
  } catch (const openvdb::Exception& error) {
    throw IoError::system(path, std::string("cannot write (") + error.what() + ")", errno);
  }
  replace_id(target.temporary_path());
  target.commit();
}

}  // namespace vdbmap
