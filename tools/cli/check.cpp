// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "vdbmap/io/vdb/map_check.h"

namespace vdbmap::cli {
namespace {

struct CheckOptions {
  std::filesystem::path file;
};

void add_options(CLI::App& app, CheckOptions& options) {
  app.add_option("FILE", options.file, "A map, its channels, or a .vdb file of another program")
      ->type_name("FILE")
      ->required();
}

std::string text_of(const std::vector<RuleResult>& results) {
  std::string text;
  for (const RuleResult& result : results) {
    text += fmt::format("{}  {}{}\n", result.passed ? "passed" : "FAILED", result.name,
                        result.detail.empty() ? "" : ": " + result.detail);
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<RuleResult>& results, const CheckOptions& options) {
  auto rules = nlohmann::ordered_json::array();
  for (const RuleResult& result : results) {
    rules.push_back({{"name", result.name}, {"passed", result.passed}, {"detail", result.detail}});
  }
  return {{"file", options.file.string()}, {"passed", all_passed(results)}, {"rules", rules}};
}

ExitCode run(const CheckOptions& options, const CommonOptions& common) {
  const std::vector<RuleResult> results = check_map_file(options.file);
  if (common.json) {
    print_json(json_of(results, options));
  } else {
    print_result(text_of(results));
  }
  return all_passed(results) ? ExitCode::kDone : ExitCode::kNo;
}

}  // namespace

Command check_command() {
  return make_command<CheckOptions>("check", "Tell whether Blender, Houdini and others can open a .vdb file",
                                    "vdbmap check map.vdb\n"
                                    "vdbmap check smoke.vdb --json",
                                    add_options, run);
}

}  // namespace vdbmap::cli
