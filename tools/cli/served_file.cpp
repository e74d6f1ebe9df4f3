// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/served_file.h"

#include <array>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vdbmap::cli {
namespace {

struct MediaType {
  std::string_view ending;
  std::string_view type;
  bool is_compressible;
};

constexpr auto kMediaTypes = std::to_array<MediaType>({
    {".html", "text/html; charset=utf-8", true},
    {".js", "text/javascript; charset=utf-8", true},
    {".css", "text/css; charset=utf-8", true},
    {".json", "application/json", true},
    {".webmanifest", "application/manifest+json", true},
    {".svg", "image/svg+xml", true},
    {".txt", "text/plain; charset=utf-8", true},
    {".wasm", "application/wasm", true},
    {".glb", "model/gltf-binary", false},
    {".png", "image/png", false},
    {".jpg", "image/jpeg", false},
    {".ico", "image/x-icon", false},
    {".woff2", "font/woff2", false},
});

const MediaType* find_media_type(const std::string& path) {
  for (const MediaType& type : kMediaTypes) {
    if (path.ends_with(type.ending)) return &type;
  }
  return nullptr;
}

// The names of a path; nothing where one of them may not be asked for.
std::optional<std::vector<std::string>> names_of_path(const std::string& path) {
  if (!path.starts_with('/') || path.find('\0') != std::string::npos) return std::nullopt;
  std::vector<std::string> names;
  for (std::size_t begin = 1; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    names.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  if (names.empty() || names.back().empty()) {
    if (!names.empty()) names.pop_back();
    names.emplace_back("index.html");
  }
  for (const std::string& name : names) {
    if (name.empty() || name.starts_with('.')) return std::nullopt;
  }
  return names;
}

std::shared_ptr<const int> own_descriptor(int descriptor) {
  return {new int(descriptor), [](const int* owned) {
            if (*owned >= 0) ::close(*owned);
            delete owned;
          }};
}

// Opens name by name, so that no link is followed on the way. A pipe does not keep it waiting.
int open_beneath(const std::filesystem::path& folder, const std::vector<std::string>& names) {
  int at = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  for (std::size_t i = 0; i < names.size() && at >= 0; ++i) {
    const int kind = i + 1 < names.size() ? O_DIRECTORY : O_NONBLOCK;
    const int next = ::openat(at, names[i].c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | kind);
    ::close(at);
    at = next;
  }
  return at;
}

}  // namespace

std::optional<ServedFile> ServedFile::open(const std::filesystem::path& folder, const std::string& path) {
  const std::optional<std::vector<std::string>> names = names_of_path(path);
  if (!names) return std::nullopt;
  const int descriptor = open_beneath(folder, *names);
  if (descriptor < 0) return std::nullopt;
  std::string whole;
  for (const std::string& name : *names) whole += "/" + name;
  ServedFile file(descriptor, std::move(whole));
  return file.is_regular_ ? std::optional(std::move(file)) : std::nullopt;
}

ServedFile::ServedFile(int descriptor, std::string path)
    : descriptor_(own_descriptor(descriptor)), path_(std::move(path)) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return;
  is_regular_ = S_ISREG(status.st_mode);
  size_ = static_cast<std::uint64_t>(status.st_size);
  const auto time = static_cast<std::uint64_t>(status.st_mtim.tv_sec) * 1'000'000'000 +
                    static_cast<std::uint64_t>(status.st_mtim.tv_nsec);
  tag_ = std::to_string(time) + "-" + std::to_string(size_) + "-" + std::to_string(status.st_ino);
}

std::size_t ServedFile::read(std::uint64_t offset, char* bytes, std::size_t count) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t size = ::pread(*descriptor_, bytes + done, count - done, static_cast<off_t>(offset + done));
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    done += static_cast<std::size_t>(size);
  }
  return done;
}

std::string media_type(const std::string& path) {
  const MediaType* const type = find_media_type(path);
  return std::string(type ? type->type : "application/octet-stream");
}

bool is_compressible(const std::string& path) {
  const MediaType* const type = find_media_type(path);
  return type && type->is_compressible;
}

bool is_named_by_content(const std::string& path) {
  return path.starts_with("/tiles/") || path.starts_with("/details/") || path.starts_with("/assets/");
}

}  // namespace vdbmap::cli
