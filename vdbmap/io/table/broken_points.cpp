// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/table/broken_points.h"

#include "vdbmap/core/error.h"

namespace vdbmap {

void BrokenPoints::add(std::size_t place, std::uint64_t line, const std::string& reason) {
  if (places_.empty()) {
    first_line_ = line;
    first_reason_ = reason;
  }
  places_.push_back(place);
}

void BrokenPoints::check(const std::filesystem::path& path, std::size_t num_whole) const {
  if (places_.size() <= num_whole) return;
  throw IoError::malformed_at_line(path, first_line_, first_reason_);
}

void BrokenPoints::note(std::vector<ReadFinding>& findings) const {
  if (places_.empty()) return;
  add_finding(findings, {"broken points left out", places_.size(),
                         "line " + std::to_string(first_line_) + ": " + first_reason_, true});
}

}  // namespace vdbmap
