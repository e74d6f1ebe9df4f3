// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/folders.h"
#include "tests/support/picture.h"
#include "tests/support/raw_files.h"
#include "tests/support/run_command.h"
#include "tools/cli/exit_code.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using test::CommandResult;

class EvaluateCommand : public testing::Test {
 protected:
  CommandResult evaluate(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "evaluate");
    return test::run_command(VDBMAP_COMMAND, arguments);
  }

  // Poses along a curve, one a second, moved sideways; those of `missing` are left out or nan.
  std::string poses_file(const std::string& name, std::size_t count, double sideways = 0,
                         const std::vector<std::size_t>& missing = {},
                         TrajectoryFormat format = TrajectoryFormat::kKitti) const {
    Trajectory poses;
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = static_cast<double>(i);
      poses.map_from_scan.emplace_back(Eigen::Translation3d(x, 0.01 * x * x + sideways, 0.1 * sideways) *
                                       Eigen::Isometry3d::Identity());
    }
    for (const std::size_t i : missing) poses.map_from_scan[i].reset();
    write_trajectory(folder_ / name, poses, format);
    return folder_ / name;
  }

  void expect_one_line_error(const CommandResult& result, ExitCode code, const std::string& part) const {
    EXPECT_EQ(result.exit_code, static_cast<int>(code));
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  }

  test::TemporaryFolder folder_;
};

TEST_F(EvaluateCommand, WritesPlotAndJsonBesideTheTable) {
  const CommandResult result = evaluate({poses_file("poses.txt", 30, 0.05), poses_file("truth.txt", 30), "--plot",
                                         folder_ / "evaluation.png", "--json", folder_ / "evaluation.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("error  ")) << result.out;
  EXPECT_EQ(test::read_picture(folder_ / "evaluation.png").width(), 1600);
  const auto report = nlohmann::json::parse(test::read_raw(folder_ / "evaluation.json"));
  EXPECT_NEAR(report["xy_m"]["max"], 0.05, 1e-9);
  EXPECT_NEAR(report["z_m"]["max"], 0.005, 1e-9);
  EXPECT_NEAR(report["aligned"]["translation_m"]["rms"], 0, 1e-9);
  EXPECT_EQ(report["relative"].size(), 3U);  // the way is 30 m long
  EXPECT_EQ(report["relative"][1]["length_m"], 5);
  EXPECT_EQ(report["kitti"]["num_segments"], 0);
  EXPECT_TRUE(report["kitti"]["translation_percent"].is_null());
}

TEST_F(EvaluateCommand, JsonWithoutAFileIsPrintedWhereverItStands) {
  const std::string poses = poses_file("poses.txt", 3);
  const auto last = evaluate({poses, poses, "--every", "1", "--json"});
  const auto first = evaluate({"--json", poses, poses});
  const auto before_another = evaluate({poses, poses, "--json", "--every", "1"});
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(nlohmann::json::parse(last.out)["num_poses"], 3);
  EXPECT_EQ(first.out, last.out);
  EXPECT_EQ(before_another.out, last.out);
}

TEST_F(EvaluateCommand, JsonNeverOverwritesPoses) {
  const std::string poses = poses_file("poses.txt", 3);
  const std::string before = test::read_raw(poses);
  expect_one_line_error(evaluate({"--json", poses, poses, "--every", "1"}), ExitCode::kWrongUsage, ".json");
  const std::string named_so = poses_file("poses.json", 3);
  expect_one_line_error(evaluate({poses, named_so, "--json", named_so}), ExitCode::kWrongUsage, "is an input too");
  EXPECT_EQ(test::read_raw(poses), before);
}

TEST_F(EvaluateCommand, TumFilesAreComparedByTime) {
  const std::string truth = poses_file("truth.tum", 6, 0, {}, TrajectoryFormat::kTum);
  const std::string estimate = poses_file("estimate.tum", 6, 0.5, {0, 3}, TrajectoryFormat::kTum);
  const CommandResult result = evaluate({estimate, truth, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["num_poses"], 6);
  EXPECT_EQ(report["num_missing"], 2);
  EXPECT_TRUE(report["poses"][3].is_null());
  EXPECT_NEAR(report["xy_m"]["max"], 0.5, 1e-9);
}

TEST_F(EvaluateCommand, TimesThatDifferALittleNeedTheOption) {
  test::write_raw(folder_ / "truth.tum", "10.00 0 0 0 0 0 0 1\n10.10 1 0 0 0 0 0 1\n");
  test::write_raw(folder_ / "estimate.tum", "10.03 0 0 0 0 0 0 1\n");
  const std::string truth = folder_ / "truth.tum";
  const std::string estimate = folder_ / "estimate.tum";
  expect_one_line_error(evaluate({estimate, truth}), ExitCode::kBadInput, "no time within 0.01 s");
  const CommandResult result = evaluate({estimate, truth, "--max-time-difference", "0.05"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("missing: 1 of 2 poses"), std::string::npos) << result.out;
  expect_one_line_error(evaluate({estimate, truth, "--max-time-difference", "-1"}), ExitCode::kWrongUsage, "-1");
}

TEST_F(EvaluateCommand, FewAndMissingPosesStillGiveAPlot) {
  for (const auto& [count, missing] : {std::pair{1U, std::vector<std::size_t>{}}, {2U, {0, 1}}, {3U, {1}}}) {
    const CommandResult result = evaluate(
        {poses_file("poses.txt", count, 0, missing), poses_file("truth.txt", count), "--plot", folder_ / "plot.png"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(test::read_picture(folder_ / "plot.png").height(), 1000);
  }
}

TEST_F(EvaluateCommand, BadInputIsToldInOneLine) {
  const std::string poses = poses_file("poses.txt", 2);
  test::write_raw(folder_ / "empty.txt", "");
  const std::string empty = folder_ / "empty.txt";
  expect_one_line_error(evaluate({empty, poses}), ExitCode::kBadInput, "empty.txt: holds no poses");
  expect_one_line_error(evaluate({poses, empty}), ExitCode::kBadInput, "empty.txt: holds no poses");
  expect_one_line_error(evaluate({poses, poses_file("three.txt", 3)}), ExitCode::kBadInput, "2 are needed");
  expect_one_line_error(evaluate({poses, poses_file("lost.txt", 2, 0, {0, 1})}), ExitCode::kBadInput,
                        "lost.txt: all poses are missing");
}

TEST_F(EvaluateCommand, OutputsThatCannotBeWrittenAreToldBeforeAnyOther) {
  const std::string poses = poses_file("poses.txt", 2);
  const std::string plot = folder_ / "missing" / "plot.png";
  const std::string json_file = folder_ / "evaluation.json";
  expect_one_line_error(evaluate({poses, poses, "--plot", plot, "--json", json_file}), ExitCode::kInputOutputFailed,
                        plot);
  EXPECT_FALSE(std::filesystem::exists(json_file));
  expect_one_line_error(evaluate({poses, poses, "--plot", folder_.path()}), ExitCode::kInputOutputFailed,
                        folder_.path());
  expect_one_line_error(evaluate({poses, poses, "--plot", poses}), ExitCode::kWrongUsage, "is an input too");
}

}  // namespace
}  // namespace vdbmap::cli
