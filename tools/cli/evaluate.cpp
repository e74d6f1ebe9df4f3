// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "registration/trajectory_error.h"
#include "tools/cli/command.h"
#include "tools/cli/output.h"
#include "tools/cli/scan_selection.h"
#include "vdbmap/io/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using registration::ErrorSummary;
using registration::success_rate;
using registration::SuccessThreshold;
using registration::TrajectoryError;

struct EvaluateOptions {
  std::filesystem::path estimate;
  std::filesystem::path truth;
  ScanSelection selection;
};

void add_options(CLI::App& app, EvaluateOptions& options) {
  app.add_option("ESTIMATE", options.estimate, "Estimated poses (KITTI or TUM)")->type_name("FILE")->required();
  app.add_option("TRUTH", options.truth, "True poses (KITTI or TUM)")->type_name("FILE")->required();
  add_scan_selection(app, options.selection);
}

std::string text_row(const std::string& name, const ErrorSummary& summary) {
  return fmt::format("{:<15}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", name, summary.median, summary.mean, summary.rms,
                     summary.max);
}

std::string success_row(const TrajectoryError& error, const SuccessThreshold& threshold) {
  return fmt::format("within {} m and {} deg: {:.1f} %\n", threshold.translation, threshold.rotation_deg,
                     100 * success_rate(error, threshold));
}

std::string text_of(const TrajectoryError& error) {
  return fmt::format("{:<15}{:>10}{:>10}{:>10}{:>10}\n", "error", "median", "mean", "rms", "max") +
         text_row("XY [m]", error.xy) + text_row("Z [m]", error.z) + text_row("XYZ [m]", error.translation) +
         text_row("rotation [deg]", error.rotation_deg) + success_row(error, registration::kFineSuccess) +
         success_row(error, registration::kCoarseSuccess) +
         fmt::format("missing: {} of {} poses\n", error.num_missing, error.num_judged);
}

nlohmann::ordered_json json_of(const ErrorSummary& summary) {
  return {{"median", summary.median}, {"mean", summary.mean}, {"rms", summary.rms}, {"max", summary.max}};
}

nlohmann::ordered_json json_of(const TrajectoryError& error, const SuccessThreshold& threshold) {
  return {{"max_translation_m", threshold.translation},
          {"max_rotation_deg", threshold.rotation_deg},
          {"rate", success_rate(error, threshold)}};
}

nlohmann::ordered_json json_of(const std::vector<std::optional<registration::PoseError>>& poses) {
  auto array = nlohmann::ordered_json::array();
  for (const auto& pose : poses) {
    if (pose) {
      array.push_back({{"xy_m", pose->xy}, {"z_m", pose->z}, {"rotation_deg", pose->rotation_deg}});
    } else {
      array.push_back(nullptr);
    }
  }
  return array;
}

nlohmann::ordered_json json_of(const TrajectoryError& error) {
  return {{"num_poses", error.num_judged},
          {"num_missing", error.num_missing},
          {"xy_m", json_of(error.xy)},
          {"z_m", json_of(error.z)},
          {"translation_m", json_of(error.translation)},
          {"rotation_deg", json_of(error.rotation_deg)},
          {"success", {json_of(error, registration::kFineSuccess), json_of(error, registration::kCoarseSuccess)}},
          {"poses", json_of(error.poses)}};
}

ExitCode run(const EvaluateOptions& options, const CommonOptions& common) {
  const Trajectory estimate = read_trajectory(options.estimate);
  const Trajectory truth = read_selected_poses(options.truth, options.selection, estimate.size());
  const TrajectoryError error = registration::evaluate_trajectory(estimate, truth);
  if (common.json) {
    print_json(json_of(error));
  } else {
    print_result(text_of(error));
  }
  return ExitCode::kDone;
}

}  // namespace

Command evaluate_command() {
  return make_command<EvaluateOptions>("evaluate", "Compare estimated poses with the true ones",
                                       "vdbmap evaluate poses.txt truth.txt\n"
                                       "vdbmap evaluate odd_poses.txt truth.txt --every 2 --offset 1 --json",
                                       add_options, run);
}

}  // namespace vdbmap::cli
