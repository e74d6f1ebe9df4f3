// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/sums_file.h"

#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

// Numbers in groups of seven bits, the lowest first; a byte with its highest bit set is not the last (LEB128). Signed
// ones alternate: 0, -1, 1, -2, ...
class PackedWriter {
 public:
  explicit PackedWriter(std::string& bytes) : bytes_(bytes) {}

  void put(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<char>(value | 0x80));
    bytes_.push_back(static_cast<char>(value));
  }

  void put_signed(std::int64_t value) {
    put(static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63));
  }

 private:
  std::string& bytes_;
};

class PackedReader {
 public:
  PackedReader(std::string_view bytes, const std::filesystem::path& path) : rest_(bytes), path_(path) {}

  bool is_at_end() const { return rest_.empty(); }

  std::uint64_t get() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      if (rest_.empty()) break;
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    throw IoError::malformed(path_, "the sums end too early");
  }

  std::int64_t get_signed() {
    const std::uint64_t value = get();
    return static_cast<std::int64_t>(value >> 1 ^ (~(value & 1) + 1));
  }

 private:
  std::string_view rest_;
  const std::filesystem::path& path_;
};

// What follows the count says whether colours and intensities follow.
constexpr std::uint64_t kHasColor = 1;
constexpr std::uint64_t kHasIntensity = 2;

void put_sums(PackedWriter& writer, const VoxelSums& sums) {
  const bool has_color = sums.num_colored > 0;
  const bool has_intensity = sums.num_with_intensity > 0;
  writer.put(static_cast<std::uint64_t>(sums.count));
  for (const std::int64_t value : sums.position) writer.put_signed(value);
  for (const std::int64_t value : sums.product) writer.put_signed(value);
  writer.put((has_color ? kHasColor : 0) | (has_intensity ? kHasIntensity : 0));
  if (has_color) {
    writer.put(static_cast<std::uint64_t>(sums.num_colored));
    for (const std::int64_t value : sums.color) writer.put_signed(value);
  }
  if (has_intensity) {
    writer.put(sums.num_with_intensity);
    writer.put_signed(sums.intensity_carry);
    writer.put_signed(sums.intensity);
  }
}

VoxelSums get_sums(PackedReader& reader) {
  VoxelSums sums;
  sums.count = static_cast<std::int64_t>(reader.get());
  for (std::int64_t& value : sums.position) value = reader.get_signed();
  for (std::int64_t& value : sums.product) value = reader.get_signed();
  const std::uint64_t has = reader.get();
  if (has & kHasColor) {
    sums.num_colored = static_cast<std::int64_t>(reader.get());
    for (std::int64_t& value : sums.color) value = reader.get_signed();
  }
  if (has & kHasIntensity) {
    sums.num_with_intensity = static_cast<std::uint32_t>(reader.get());
    sums.intensity_carry = static_cast<std::int32_t>(reader.get_signed());
    sums.intensity = reader.get_signed();
  }
  return sums;
}

// Keys rise: their differences are small.
void put_block(PackedWriter& writer, BlockKey block, const BlockContent& content) {
  writer.put(static_cast<std::uint64_t>(block));
  writer.put(content.sums.size());
  KeyInBlock last_key = 0;
  for (const KeyedSums& voxel : content.sums) {
    writer.put(voxel.key - std::exchange(last_key, voxel.key));
    put_sums(writer, voxel.sums);
  }
  writer.put(content.votes.size());
  std::uint64_t last_voxel = static_cast<std::uint64_t>(key_of_voxel(block, 0));
  for (const LabelVotes& votes : content.votes) {
    const auto voxel = static_cast<std::uint64_t>(votes.voxel);
    writer.put(voxel - std::exchange(last_voxel, voxel));
    writer.put_signed(votes.label);
    writer.put(static_cast<std::uint64_t>(votes.count));
  }
}

BlockContent get_block(PackedReader& reader, BlockKey block) {
  BlockContent content;
  const std::size_t num_voxels = reader.get();
  content.sums.reserve(num_voxels);
  KeyInBlock key = 0;
  for (std::size_t i = 0; i < num_voxels; ++i) {
    key += static_cast<KeyInBlock>(reader.get());
    content.sums.push_back({key, get_sums(reader)});
  }
  content.votes.resize(reader.get());
  auto voxel = static_cast<std::uint64_t>(key_of_voxel(block, 0));
  for (LabelVotes& votes : content.votes) {
    voxel += reader.get();
    const auto label = static_cast<std::int32_t>(reader.get_signed());
    votes = {VoxelKey{voxel}, label, static_cast<std::int64_t>(reader.get())};
  }
  return content;
}

void append_bytes(const std::filesystem::path& path, std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) throw IoError::system(path, "cannot create", errno);
  int error = 0;
  while (!bytes.empty() && error == 0) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    if (written < 0 && errno != EINTR) error = errno;
  }
  ::close(descriptor);
  if (error != 0) throw IoError::system(path, "cannot write", error);
}

}  // namespace

std::string pack_sums(const VoxelBlocks& blocks) {
  std::string bytes;
  PackedWriter writer(bytes);
  for (const auto& [block, content] : blocks) put_block(writer, block, content);
  return bytes;
}

void add_packed_sums(std::string_view bytes, const std::filesystem::path& path, VoxelBlocks& blocks) {
  PackedReader reader(bytes, path);
  while (!reader.is_at_end()) {
    const auto block = BlockKey{reader.get()};
    add_content(blocks[block], get_block(reader, block));
  }
}

void append_sums(const std::filesystem::path& path, const VoxelBlocks& blocks) {
  append_bytes(path, pack_sums(blocks));
}

void add_sums_of_file(const std::filesystem::path& path, VoxelBlocks& blocks) {
  ByteReader file(path);
  add_packed_sums(file.bytes(file.size()), path, blocks);
}

}  // namespace vdbmap
