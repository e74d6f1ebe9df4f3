// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/vdb_outline.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

constexpr std::string_view kMagic(" BDV\0\0\0\0", 8);
constexpr std::uint32_t kNewestVersion = 224;
constexpr std::uint32_t kOldestVersion = 218;          // before, ids have another form; OpenVDB 1.0 wrote 219
constexpr std::uint32_t kCompressionFlagsSince = 222;  // of every grid

// A file read from place to place; whatever would leave it throws.
class Walker {
 public:
  explicit Walker(const std::filesystem::path& path) : path_(path) {
    check_regular_file(path);
    stream_.open(path, std::ios::binary);
    if (!stream_) throw IoError::system(path, "cannot open", errno);
    size_ = std::filesystem::file_size(path);
  }

  [[noreturn]] void fail(const std::string& reason) const { throw IoError::malformed_at_byte(path_, offset_, reason); }

  std::string text(std::uint64_t size) {
    require(size);
    std::string bytes(size, '\0');
    stream_.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!stream_) throw IoError::system(path_, "cannot read", errno);
    offset_ += size;
    return bytes;
  }

  template <Scalar T>
  T number() {
    return load<T>(text(sizeof(T)).data());
  }

  // A text after its length.
  std::string counted_text() { return text(number<std::uint32_t>()); }

  void skip_counted() {
    const auto size = number<std::uint32_t>();
    require(size);
    seek(offset_ + size);
  }

  void seek(std::uint64_t offset) {
    if (offset > size_) fail("the file was cut: " + std::to_string(offset - size_) + " bytes are missing");
    stream_.seekg(static_cast<std::streamoff>(offset));
    offset_ = offset;
  }

  std::uint64_t offset() const { return offset_; }

 private:
  void require(std::uint64_t size) const {
    if (size > size_ - offset_) fail("the file was cut: " + std::to_string(size) + " bytes are expected here");
  }

  const std::filesystem::path& path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t offset_ = 0;
};

void check_magic(Walker& walker, const std::filesystem::path& path) {
  try {
    if (walker.text(kMagic.size()) == kMagic) return;
  } catch (const IoError& error) {
    if (error.kind() == IoError::Kind::kSystem) throw;
  }
  throw IoError::malformed(path, "is not an OpenVDB file");
}

void read_header(Walker& walker, VdbOutline& outline) {
  outline.version = walker.number<std::uint32_t>();
  if (outline.version < kOldestVersion || outline.version > kNewestVersion) {
    walker.fail("OpenVDB file version " + std::to_string(outline.version) + ", expected " +
                std::to_string(kOldestVersion) + " to " + std::to_string(kNewestVersion));
  }
  walker.text(8);  // library version
  outline.has_grid_offsets = walker.number<std::uint8_t>() != 0;
  const std::string id = walker.text(36);
  // OpenVDB takes a file without a proper id for an empty one.
  if (id.find_first_not_of("0123456789abcdefABCDEF-") != std::string::npos) walker.fail("the id of the file is broken");
}

void skip_metadata(Walker& walker) {
  const auto count = walker.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    walker.skip_counted();  // name
    walker.skip_counted();  // type
    walker.skip_counted();  // value
  }
}

VdbGridOutline read_grid(Walker& walker, std::uint32_t version) {
  VdbGridOutline grid;
  const std::string unique_name = walker.counted_text();
  grid.name = unique_name.substr(0, unique_name.find('\x1e'));  // a number follows where names repeat
  grid.type = walker.counted_text();
  grid.shares_tree = !walker.counted_text().empty();  // the grid whose tree it is
  const auto begin = walker.number<std::uint64_t>();
  const auto blocks = walker.number<std::uint64_t>();
  const auto end = walker.number<std::uint64_t>();
  // A grid that shares its tree has none of its own in the file, and so no offset of it.
  const bool is_ordered = grid.shares_tree ? begin <= end : begin <= blocks && blocks <= end;
  if (begin < walker.offset() || !is_ordered) walker.fail("the offsets of a grid run backwards");
  walker.seek(begin);
  if (version >= kCompressionFlagsSince) grid.compression = walker.number<std::uint32_t>();
  skip_metadata(walker);
  walker.skip_counted();  // the type of the transform
  walker.seek(end);
  return grid;
}

}  // namespace

VdbOutline read_vdb_outline(const std::filesystem::path& path) {
  Walker walker(path);
  check_magic(walker, path);
  VdbOutline outline;
  read_header(walker, outline);
  skip_metadata(walker);
  const auto num_grids = walker.number<std::uint32_t>();
  for (std::uint32_t i = 0; outline.has_grid_offsets && i < num_grids; ++i) {
    outline.grids.push_back(read_grid(walker, outline.version));
  }
  return outline;
}

}  // namespace vdbmap
