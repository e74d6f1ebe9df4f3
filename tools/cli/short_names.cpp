// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/short_names.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace vdbmap::cli {
namespace {

// The last parts of a path, as many as asked for: "epoch1/poses.txt" of 2.
std::string tail_of(const std::filesystem::path& path, std::size_t num_parts) {
  const auto length = static_cast<std::size_t>(std::distance(path.begin(), path.end()));
  std::filesystem::path tail;
  for (auto part = std::next(path.begin(), static_cast<std::ptrdiff_t>(length - std::min(length, num_parts)));
       part != path.end(); ++part) {
    tail /= *part;
  }
  return tail.string();
}

}  // namespace

std::vector<std::string> short_names(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) {
    const auto others = [&](std::size_t num_parts) {
      return std::ranges::count_if(files, [&](const std::filesystem::path& other) {
        return other != file && tail_of(other, num_parts) == tail_of(file, num_parts);
      });
    };
    const auto length = static_cast<std::size_t>(std::distance(file.begin(), file.end()));
    std::size_t num_parts = 1;
    while (num_parts < length && others(num_parts) > 0) ++num_parts;
    names.push_back(tail_of(file, num_parts));
  }
  return names;
}

}  // namespace vdbmap::cli
