// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "registration/evaluation/time_association.h"
#include "registration/evaluation/trajectory_plot.h"
#include "tools/cli/command.h"
#include "tools/cli/evaluation_text.h"
#include "tools/cli/json_output.h"
#include "tools/cli/map_output.h"
#include "tools/cli/output.h"
#include "tools/cli/reading.h"
#include "tools/cli/scan_selection.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

struct EvaluateOptions {
  std::filesystem::path estimate;
  std::filesystem::path truth;
  ScanSelection selection;
  double max_time_difference = registration::kMaxTimeDifference;
  std::filesystem::path plot;
  JsonOutput json;
};

/// Estimated poses beside the true ones of the same scans.
using Comparison = registration::TimeAssociation;

void add_options(CLI::App& app, EvaluateOptions& options) {
  app.add_option("ESTIMATE", options.estimate, "Estimated poses (KITTI or TUM)")->type_name("FILE")->required();
  app.add_option(
         "TRUTH", options.truth,
         "True poses (KITTI or TUM); each without an estimate is missing. Of poses that are denser in time than "
         "the estimates, only those count as missing that fill a hole between estimates, one for each of "
         "their own intervals")
      ->type_name("FILE")
      ->required();
  add_scan_selection(app, options.selection);
  app.add_option("--max-time-difference", options.max_time_difference,
                 "Two TUM files are compared by time: so far apart the times of a scan may be [s]")
      ->check(CLI::NonNegativeNumber.description(""))
      ->type_name("S")
      ->capture_default_str();
  app.add_option("--plot", options.plot,
                 "Draw the plan view, the histograms and the figures into this .png or .jpg file")
      ->type_name("FILE");
  add_json_output(app, options.json, "the poses");
}

void check_outputs(const EvaluateOptions& options) {
  const std::vector<std::filesystem::path> inputs = {options.estimate, options.truth};
  if (!options.plot.empty()) check_output(options.plot, kPictureKind, inputs);
  if (!options.json.file.empty()) check_output(options.json.file, kJsonKind, inputs);
}

Comparison compare_by_time(const Trajectory& estimate, const Trajectory& truth, const EvaluateOptions& options) {
  auto association = registration::associate_by_time(estimate, truth, options.max_time_difference);
  if (association.num_unmatched == estimate.size()) {
    throw IoError::malformed(options.estimate, fmt::format("no time within {} s of one in {}",
                                                           options.max_time_difference, options.truth.string()));
  }
  return association;
}

// A TUM file leaves missing poses out, so that lines tell nothing; in a KITTI file they are all there is.
Comparison read_poses(const EvaluateOptions& options) {
  const Trajectory estimate = read_trajectory(options.estimate);
  const Trajectory truth = read_trajectory(options.truth);
  ReadingReport reading;
  reading.add(options.estimate, estimate.findings);
  reading.add(options.truth, truth.findings);
  reading.warn();
  const bool have_times = !estimate.times.empty() && !truth.times.empty();
  if (have_times) return compare_by_time(estimate, select(truth, options.selection), options);
  return {estimate, selected_poses(truth, options.truth, options.selection, estimate.size())};
}

void check_truth(const Comparison& poses, const EvaluateOptions& options) {
  const auto& truth = poses.truth.map_from_scan;
  if (std::any_of(truth.begin(), truth.end(), [](const auto& pose) { return pose.has_value(); })) return;
  throw IoError::malformed(options.truth, "all poses are missing, nothing to compare with");
}

void write_plot(const EvaluateOptions& options, const Comparison& poses) {
  constexpr std::size_t kLongTitle = 80;
  registration::TrajectoryPlotOptions plot;
  plot.title = options.estimate.string() + " against " + options.truth.string();
  if (plot.title.size() > kLongTitle) {
    plot.title = options.estimate.filename().string() + " against " + options.truth.filename().string();
  }
  write_picture(options.plot, registration::plot_trajectory(poses.estimate, poses.truth, plot));
}

ExitCode run(const EvaluateOptions& options, const CommonOptions&) {
  check_outputs(options);
  const Comparison poses = read_poses(options);
  check_truth(poses, options);
  Evaluation evaluation = evaluate(poses.estimate, poses.truth);
  evaluation.num_unmatched = poses.num_unmatched;
  evaluation.num_not_judged = poses.num_not_judged;

  if (!options.plot.empty()) write_plot(options, poses);
  if (!options.json.file.empty()) write_json(options.json.file, json_of(evaluation));
  if (options.json.is_on_stdout()) {
    print_json(json_of(evaluation));
  } else {
    print_result(text_of(evaluation));
  }
  return ExitCode::kDone;
}

}  // namespace

Command evaluate_command() {
  return make_command<EvaluateOptions>("evaluate", "Compare estimated poses with the true ones",
                                       "vdbmap evaluate poses.txt truth.txt\n"
                                       "vdbmap evaluate poses.txt truth.txt --plot evaluation.png --json "
                                       "evaluation.json\n"
                                       "vdbmap evaluate odd_poses.txt truth.txt --every 2 --offset 1 --json",
                                       add_options, run);
}

}  // namespace vdbmap::cli
