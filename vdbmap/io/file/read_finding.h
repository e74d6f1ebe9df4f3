// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace vdbmap {

/// Something that was left out of a file, or taken although it is doubtful: the rest of the file is used all the same.
struct ReadFinding {
  std::string what;  ///< after its number: "withheld points left out"; after no number: "the layout is that of ..."
  std::size_t count = 0;   ///< of such things; 0: what concerns the file as a whole
  std::string first = {};  ///< where the first one is, or what is wrong with it; may be empty
  bool is_damage = false;  ///< the file is not as its format says: strict reading refuses it

  /// One line: "3 withheld points left out (first: point 12)".
  std::string text() const;

  bool operator==(const ReadFinding&) const = default;
};

/// What was noticed of one of several files.
struct FileFinding {
  std::filesystem::path file;
  ReadFinding finding;
};

/// Damage: a file that ends before the last of the points it promises.
ReadFinding missing_points(std::size_t num_promised, std::size_t num_found);

/// Adds a finding to those of the same file, or counts it to one that says the same of other things.
void add_finding(std::vector<ReadFinding>& findings, const ReadFinding& finding);

}  // namespace vdbmap
