// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vdbmap/io/file/read_finding.h"

namespace vdbmap {

/// The points of a text that cannot be read, and why the first of them cannot.
class BrokenPoints {
 public:
  /// `place` among all points of the file, from 0; `line` from 1.
  void add(std::size_t place, std::uint64_t line, const std::string& reason);

  /// The rule that tells a text with some damage from one that is something else: throws IoError with the first reason
  /// where more points are broken than `num_whole`.
  void check(const std::filesystem::path& path, std::size_t num_whole) const;

  const std::vector<std::size_t>& places() const { return places_; }  ///< rising

  /// Damage; only where there is any.
  void note(std::vector<ReadFinding>& findings) const;

 private:
  std::vector<std::size_t> places_;
  std::uint64_t first_line_ = 0;
  std::string first_reason_;
};

}  // namespace vdbmap
