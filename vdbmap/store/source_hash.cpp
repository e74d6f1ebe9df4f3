// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/source_hash.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>

#include <fcntl.h>
#include <unistd.h>
#include <xxhash.h>

#include "vdbmap/core/error.h"
#include "vdbmap/core/parallel.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap {
namespace {

// The XXH3 hash of 128 bits of what is added.
class ContentHash {
 public:
  ContentHash() : state_(XXH3_createState(), XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

  void add(const void* bytes, std::size_t size) { XXH3_128bits_update(state_.get(), bytes, size); }

  // 32 hexadecimal digits.
  std::string digits() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    std::array<char, 33> text;
    std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text.data();
  }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

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

// A whole file in map coordinates is its content; for others the hash goes on.
std::string hash_of_input(const MapInput& input, const std::string& hash_of_content) {
  if (!input.map_from_scan && !input.scan.turn) return hash_of_content;
  ContentHash hash;
  hash.add(hash_of_content.data(), hash_of_content.size());
  const std::uint64_t turn = input.scan.turn ? *input.scan.turn + 1 : 0;
  hash.add(&turn, sizeof(turn));
  if (input.map_from_scan) {
    const Eigen::Matrix<double, 3, 4> pose = input.map_from_scan->matrix().topRows<3>();
    hash.add(pose.data(), sizeof(double) * static_cast<std::size_t>(pose.size()));
  }
  return hash.digits();
}

std::string name_of(const ScanPlace& scan) { return ScanPlace{scan.file.filename(), scan.turn}.name(); }

}  // namespace

std::vector<MapSource> identify_sources(const std::vector<MapInput>& inputs,
                                        const std::function<void()>& on_file_done) {
  std::set<std::filesystem::path> distinct;
  for (const MapInput& input : inputs) distinct.insert(input.scan.file);
  const std::vector<std::filesystem::path> files(distinct.begin(), distinct.end());
  std::vector<std::string> hashes(files.size());
  parallel_for(files.size(), [&](std::size_t i) {
    hashes[i] = hash_of_file(files[i]);
    on_file_done();
  });
  std::vector<MapSource> sources;
  for (const MapInput& input : inputs) {
    const auto file = std::ranges::lower_bound(files, input.scan.file);
    sources.push_back(
        {name_of(input.scan), hash_of_input(input, hashes[static_cast<std::size_t>(file - files.begin())])});
  }
  return sources;
}

}  // namespace vdbmap
