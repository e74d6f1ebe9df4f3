// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/map_check.h"

#include <algorithm>
#include <array>

#include "vdbmap/io/vdb/map_metadata.h"
#include "vdbmap/io/vdb/map_rules.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap {
namespace {

enum class Scope {
  kAnyFile,   // what readers need
  kOurFiles,  // what we promise beyond, of maps and their channels
};

struct Rule {
  const char* name;
  Finding (*check)(const CheckedFile&);
  Scope scope = Scope::kAnyFile;
};

constexpr std::array kRules = {
    Rule{"file_version", check_file_version, Scope::kOurFiles},
    Rule{"grid_offsets", check_grid_offsets, Scope::kOurFiles},
    Rule{"compression", check_compression, Scope::kOurFiles},
    Rule{"creator", check_creator},
    Rule{"grid_names", check_grid_names},
    Rule{"grid_types", check_grid_types},
    Rule{"density_and_color", check_density_and_color},
    Rule{"channel_types", check_channel_types},
    Rule{"mean_offsets", check_mean_offsets, Scope::kOurFiles},
    Rule{"backgrounds", check_backgrounds},
    Rule{"vector_types", check_vector_types, Scope::kOurFiles},
    Rule{"grid_classes", check_grid_classes, Scope::kOurFiles},
    Rule{"finite_values", check_finite_values},
    Rule{"index_range", check_index_range},
    Rule{"empty_leaves", check_empty_leaves, Scope::kOurFiles},
    Rule{"half_floats", check_half_floats, Scope::kOurFiles},
    Rule{"point_attributes", check_point_attributes},
    Rule{"statistics", check_statistics},
    Rule{"transforms", check_transforms},
    Rule{"anchor", check_anchor_metadata, Scope::kOurFiles},
    Rule{"known_point", check_known_point, Scope::kOurFiles},
    Rule{"dense_size", check_dense_size},
};

CheckedFile read_checked_file(const std::filesystem::path& path) {
  VdbOutline outline = read_vdb_outline(path);
  VdbContent content = read_vdb(path);
  const bool is_ours = is_file_of_vdbmap(*content.metadata);
  return {path, std::move(outline), std::move(content.grids), std::move(content.metadata), is_ours};
}

RuleResult result_of(const Rule& rule, const CheckedFile& file) {
  const Finding finding = rule.check(file);
  if (finding.problems.empty()) return {rule.name, true, finding.remark};
  std::string detail = finding.problems.front();
  if (finding.problems.size() > 1) detail += " (and " + std::to_string(finding.problems.size() - 1) + " more)";
  return {rule.name, false, detail};
}

}  // namespace

CheckResult check_vdb_file(const std::filesystem::path& path) {
  const CheckedFile file = read_checked_file(path);
  CheckResult result{file.is_ours, {}};
  for (const Rule& rule : kRules) {
    if (file.is_ours || rule.scope == Scope::kAnyFile) result.rules.push_back(result_of(rule, file));
  }
  return result;
}

std::vector<RuleResult> check_map_file(const std::filesystem::path& path) { return check_vdb_file(path).rules; }

bool all_passed(const std::vector<RuleResult>& results) {
  return std::ranges::all_of(results, [](const RuleResult& result) { return result.passed; });
}

}  // namespace vdbmap
