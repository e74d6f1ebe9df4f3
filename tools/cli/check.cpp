// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "tools/cli/child_process.h"
#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "tools/cli/progress.h"
#include "vdbmap/io/file/text.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/store/city_check.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::cli {
namespace {

struct CheckOptions {
  std::filesystem::path file;
};

void add_options(CLI::App& app, CheckOptions& options) {
  app.add_option("FILE", options.file, "A map, its channels, a city, or a .vdb file of another program")
      ->type_name("FILE")
      ->required();
}

std::string text_of(const CheckResult& result, const CheckOptions& options) {
  std::string text;
  if (!result.is_ours) {
    text = printable(options.file.string()) + ": not a map of vdbmap, judged by what Blender and Houdini need\n";
  }
  for (const RuleResult& rule : result.rules) {
    text += fmt::format("{}  {}{}\n", rule.passed ? "passed" : "FAILED", rule.name,
                        rule.detail.empty() ? "" : ": " + printable(rule.detail));
  }
  return text;
}

nlohmann::ordered_json json_of(const CheckResult& result, const CheckOptions& options) {
  auto rules = nlohmann::ordered_json::array();
  for (const RuleResult& rule : result.rules) {
    rules.push_back({{"name", rule.name}, {"passed", rule.passed}, {"detail", rule.detail}});
  }
  return {{"file", options.file.string()},
          {"is_map", result.is_ours},
          {"passed", all_passed(result.rules)},
          {"rules", rules}};
}

ExitCode run_here(const CheckOptions& options, const CommonOptions& common) {
  const CheckResult result = check_vdb_file(options.file);
  if (common.json) {
    print_json(json_of(result, options));
  } else {
    print_result(text_of(result, options));
  }
  return all_passed(result.rules) ? ExitCode::kDone : ExitCode::kNo;
}

std::string text_of(const CityCheckResult& result) {
  std::string text;
  for (const CityProblem& problem : result.problems) {
    text += fmt::format("FAILED  {}: {}\n", printable(problem.file.string()), printable(problem.what));
  }
  const std::string parts = result.num_parts == 0 ? "" : fmt::format(" and {} parts", result.num_parts);
  return text + fmt::format("{}  {} tiles{} of {} epochs\n", result.problems.empty() ? "passed" : "FAILED",
                            result.num_tiles, parts, result.num_epochs);
}

nlohmann::ordered_json json_of(const CityCheckResult& result, const std::filesystem::path& folder) {
  auto problems = nlohmann::ordered_json::array();
  for (const CityProblem& problem : result.problems) {
    problems.push_back({{"file", problem.file.string()}, {"what", problem.what}});
  }
  return {{"folder", folder.string()},   {"is_city", true},           {"passed", result.problems.empty()},
          {"epochs", result.num_epochs}, {"tiles", result.num_tiles}, {"parts", result.num_parts},
          {"problems", problems}};
}

ExitCode run_for_city(const std::filesystem::path& path, const CommonOptions& common) {
  const City city = open_city(path);
  Progress progress("checking tiles", city.manifest.tiles.size() + city.manifest.parts.size(), common);
  const CityCheckResult result = check_city(city.folder, [&progress] { progress.advance(); });
  if (common.json) {
    print_json(json_of(result, path));
  } else {
    print_result(text_of(result));
  }
  return result.problems.empty() ? ExitCode::kDone : ExitCode::kNo;
}

ExitCode run(const CheckOptions& options, const CommonOptions& common) {
  if (is_city(options.file)) return run_for_city(options.file, common);
  return run_in_child(
      options.file, [&] { return run_here(options, common); }, ChildLimits::for_file(options.file));
}

}  // namespace

Command check_command() {
  return make_command<CheckOptions>(
      "check", "Tell whether Blender, Houdini and others can open a .vdb file, and whether a city is whole",
      "vdbmap check map.vdb\n"
      "vdbmap check city/\n"
      "vdbmap check smoke.vdb --json",
      add_options, run);
}

}  // namespace vdbmap::cli
