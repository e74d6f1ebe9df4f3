// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vdbmap {

/// Whether a file keeps one of the rules that Blender, Houdini and other readers of .vdb files need.
struct RuleResult {
  std::string name;
  bool passed = false;
  std::string detail;  ///< what was found; of a broken rule the first place and how many there are
};

/// Judges any .vdb file, ours and foreign ones, by every rule. Throws IoError for a file that cannot be read as
/// OpenVDB.
std::vector<RuleResult> check_map_file(const std::filesystem::path& path);

/// Whether all rules are kept.
bool all_passed(const std::vector<RuleResult>& results);

}  // namespace vdbmap
