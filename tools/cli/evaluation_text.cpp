// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/evaluation_text.h"

#include <numbers>
#include <span>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "registration/evaluation/trajectory_alignment.h"

namespace vdbmap::cli {
namespace {

using nlohmann::ordered_json;
using registration::ErrorSummary;
using registration::RelativeError;
using registration::success_rate;
using registration::SuccessThreshold;
using registration::TrajectoryError;

constexpr double kDegPerRad = 180 / std::numbers::pi;

std::string text_row(const std::string& name, const ErrorSummary& summary) {
  return fmt::format("{:<15}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", name, summary.median, summary.mean, summary.rms,
                     summary.max);
}

std::string success_row(const TrajectoryError& error, const SuccessThreshold& threshold) {
  return fmt::format("within {} m and {} deg: {:.1f} %\n", threshold.translation, threshold.rotation_deg,
                     100 * success_rate(error, threshold));
}

std::string text_of(std::span<const RelativeError> errors) {
  std::string text;
  for (const RelativeError& error : errors) {
    text += fmt::format("{:<15}{:>10}{:>10.2f}{:>10.4f}{:>10.3f}{:>10.5f}\n", fmt::format("over {:g} m", error.length),
                        error.num_segments, error.driven, error.translation.mean, error.translation_percent(),
                        error.rotation_deg_per_m());
  }
  return text;
}

std::string relative_text(const Evaluation& evaluation) {
  if (evaluation.over_short_lengths.empty()) return "";
  std::string text = fmt::format("\n{:<15}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "drift, mean", "segments", "way [m]",
                                 "[m]", "[%]", "[deg/m]");
  text += text_of(evaluation.over_short_lengths) + text_of(evaluation.over_kitti_lengths);
  const registration::KittiScore score = registration::kitti_score(evaluation.over_kitti_lengths);
  if (score.num_segments == 0) return text;
  return text + fmt::format("KITTI score: {:.4f} %, {:.6f} deg/m over {} segments\n", score.translation_percent,
                            score.rotation_deg_per_m, score.num_segments);
}

ordered_json json_of(const ErrorSummary& summary) {
  return {{"median", summary.median}, {"mean", summary.mean}, {"rms", summary.rms}, {"max", summary.max}};
}

ordered_json json_of(const TrajectoryError& error, const SuccessThreshold& threshold) {
  return {{"max_translation_m", threshold.translation},
          {"max_rotation_deg", threshold.rotation_deg},
          {"rate", success_rate(error, threshold)}};
}

ordered_json json_of(const std::vector<std::optional<registration::PoseError>>& poses) {
  auto array = ordered_json::array();
  for (const auto& pose : poses) {
    if (pose) {
      array.push_back({{"xy_m", pose->xy}, {"z_m", pose->z}, {"rotation_deg", pose->rotation_deg}});
    } else {
      array.push_back(nullptr);
    }
  }
  return array;
}

ordered_json json_of_alignment(const Evaluation& evaluation) {
  if (!evaluation.aligned) return nullptr;
  const Eigen::Isometry3d& alignment = *evaluation.truth_from_estimate;
  auto rows = ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(alignment.matrix()(row, column));
  }
  return {{"xy_m", json_of(evaluation.aligned->xy)},
          {"z_m", json_of(evaluation.aligned->z)},
          {"translation_m", json_of(evaluation.aligned->translation)},
          {"truth_from_estimate", rows},
          {"rotation_deg", Eigen::AngleAxisd(alignment.linear()).angle() * kDegPerRad}};
}

ordered_json json_of(std::span<const RelativeError> errors) {
  auto array = ordered_json::array();
  for (const RelativeError& error : errors) {
    array.push_back({{"length_m", error.length},
                     {"mean_driven_m", error.driven},
                     {"num_segments", error.num_segments},
                     {"num_missing", error.num_missing},
                     {"translation_m", json_of(error.translation)},
                     {"rotation_deg", json_of(error.rotation_deg)},
                     {"translation_percent", error.translation_percent()},
                     {"rotation_deg_per_m", error.rotation_deg_per_m()}});
  }
  return array;
}

ordered_json json_of_kitti(const std::vector<RelativeError>& errors) {
  const registration::KittiScore score = registration::kitti_score(errors);
  return {{"translation_percent", score.translation_percent},
          {"rotation_deg_per_m", score.rotation_deg_per_m},
          {"num_segments", score.num_segments},
          {"lengths", json_of(errors)}};
}

}  // namespace

Evaluation evaluate(const Trajectory& estimate, const Trajectory& truth) {
  Evaluation evaluation;
  evaluation.absolute = registration::evaluate_trajectory(estimate, truth);
  evaluation.truth_from_estimate = registration::align_trajectory(estimate, truth);
  if (evaluation.truth_from_estimate) {
    evaluation.aligned =
        registration::evaluate_trajectory(registration::moved(estimate, *evaluation.truth_from_estimate), truth);
  }
  evaluation.over_short_lengths = registration::relative_errors(estimate, truth, registration::kShortLengths);
  evaluation.over_kitti_lengths =
      registration::relative_errors(estimate, truth, registration::kKittiLengths, registration::kKittiStartStep);
  return evaluation;
}

std::string text_of(const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.absolute;
  std::string text = fmt::format("{:<15}{:>10}{:>10}{:>10}{:>10}\n", "error", "median", "mean", "rms", "max") +
                     text_row("XY [m]", error.xy) + text_row("Z [m]", error.z) + text_row("XYZ [m]", error.translation);
  if (evaluation.aligned) text += text_row("aligned [m]", evaluation.aligned->translation);
  text += text_row("rotation [deg]", error.rotation_deg) + success_row(error, registration::kFineSuccess) +
          success_row(error, registration::kCoarseSuccess) +
          fmt::format("missing: {} of {} poses\n", error.num_missing, error.num_judged);
  if (evaluation.num_unmatched > 0) text += fmt::format("near no true time: {} poses\n", evaluation.num_unmatched);
  if (evaluation.num_not_judged > 0) {
    text += fmt::format("true poses between the scans, not judged: {}\n", evaluation.num_not_judged);
  }
  return text + relative_text(evaluation);
}

ordered_json json_of(const Evaluation& evaluation) {
  const TrajectoryError& error = evaluation.absolute;
  return {{"num_poses", error.num_judged},
          {"num_missing", error.num_missing},
          {"num_unmatched", evaluation.num_unmatched},
          {"num_not_judged", evaluation.num_not_judged},
          {"xy_m", json_of(error.xy)},
          {"z_m", json_of(error.z)},
          {"translation_m", json_of(error.translation)},
          {"rotation_deg", json_of(error.rotation_deg)},
          {"aligned", json_of_alignment(evaluation)},
          {"relative", json_of(evaluation.over_short_lengths)},
          {"kitti", json_of_kitti(evaluation.over_kitti_lengths)},
          {"success", {json_of(error, registration::kFineSuccess), json_of(error, registration::kCoarseSuccess)}},
          {"poses", json_of(error.poses)}};
}

}  // namespace vdbmap::cli
