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

/// What was found in a file.
struct CheckResult {
  bool is_ours = false;  ///< a map or its channels, by the metadata of the file
  std::vector<RuleResult> rules;
};

/// Judges any .vdb file: a map and its channels by every rule, a file of another program by those that Blender and
/// Houdini need of it: that there is a `density` to show, grids can be told apart, are of types and have transforms
/// that both know, and hold finite values at indices in range. Throws IoError for a file that cannot be read as
/// OpenVDB.
CheckResult check_vdb_file(const std::filesystem::path& path);

/// The rules of check_vdb_file() alone.
std::vector<RuleResult> check_map_file(const std::filesystem::path& path);

/// Whether all rules are kept.
bool all_passed(const std::vector<RuleResult>& results);

}  // namespace vdbmap
