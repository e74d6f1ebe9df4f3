// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/folders.h"
#include "tests/support/run_command.h"
#include "tools/cli/command.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::cli {
namespace {

using test::CommandResult;
using test::RunOptions;

CommandResult run_vdbmap(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
  return test::run_command(VDBMAP_COMMAND, arguments, options);
}

void expect_one_line_error(const CommandResult& result, ExitCode code) {
  EXPECT_EQ(result.exit_code, static_cast<int>(code));
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(result.err.starts_with("vdbmap: ")) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_TRUE(result.err.ends_with('\n'));
}

class Evaluate : public testing::Test {
 protected:
  // Poses 1 m apart along x, shifted sideways.
  std::string poses_file(const std::string& name, std::size_t count, double sideways = 0, double step = 1) const {
    Trajectory poses;
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(step * static_cast<double>(i), sideways, 0);
      poses.map_from_scan.emplace_back(pose);
    }
    write_trajectory(folder_ / name, poses, TrajectoryFormat::kKitti);
    return folder_ / name;
  }

  test::TemporaryFolder folder_;
};

TEST(Command, HelpOfEveryCommandEndsWithExamples) {
  for (const Command& command : all_commands()) {
    const CommandResult result = run_vdbmap({command.name, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    const std::size_t examples = result.out.find("\nExamples:\n  vdbmap " + command.name);
    EXPECT_NE(examples, std::string::npos) << result.out;
    EXPECT_LT(result.out.find("Options:"), examples) << result.out;
  }
}

TEST(Command, HelpListsEveryCommand) {
  const CommandResult result = run_vdbmap({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const Command& command : all_commands()) {
    EXPECT_NE(result.out.find("\n  " + command.name + " "), std::string::npos) << result.out;
  }
}

TEST(Command, VersionIsOneLine) {
  const CommandResult result = run_vdbmap({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("vdbmap ")) << result.out;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
}

TEST(Command, WrongUsageIsToldInOneLine) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {""},
      {"no-such-command"},
      {"line\nbreak"},
      {"--no-such-option"},
      {"evaluate"},
      {"evaluate", "a", "b", "c"},
      {"evaluate", "a", "b", "--every"},
      {"evaluate", "a", "b", "--every", "0"},
      {"evaluate", "a", "b", "--every", "2.5"},
      {"evaluate", "a", "b", "--offset", "-1"},
      {"evaluate", "a", "b", "--threads", "-1"},
      {"evaluate", "a", "b", "--threads", "many"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_one_line_error(run_vdbmap(arguments), ExitCode::kWrongUsage);
  }
}

TEST_F(Evaluate, PrintsATable) {
  const CommandResult result =
      run_vdbmap({"evaluate", poses_file("estimate.txt", 3, 0.25), poses_file("truth.txt", 3)});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out,
            "error              median      mean       rms       max\n"
            "XY [m]             0.2500    0.2500    0.2500    0.2500\n"
            "Z [m]              0.0000    0.0000    0.0000    0.0000\n"
            "XYZ [m]            0.2500    0.2500    0.2500    0.2500\n"
            "aligned [m]        0.0000    0.0000    0.0000    0.0000\n"
            "rotation [deg]     0.0000    0.0000    0.0000    0.0000\n"
            "within 0.1 m and 0.5 deg: 0.0 %\n"
            "within 2 m and 5 deg: 100.0 %\n"
            "missing: 0 of 3 poses\n"
            "\n"
            "drift, mean      segments   way [m]       [m]       [%]   [deg/m]\n"
            "over 1 m                1      2.00    0.0000     0.000   0.00000\n");
}

TEST_F(Evaluate, SelectsLinesOfTheTruth) {
  const std::string odd = poses_file("odd.txt", 2, 0, 2);  // at 0 m and 2 m, the truth at 1 m and 3 m
  const CommandResult result =
      run_vdbmap({"evaluate", odd, poses_file("truth.txt", 4), "--every", "2", "--offset", "1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["num_poses"], 2);
  EXPECT_EQ(report["num_missing"], 0);
  EXPECT_EQ(report["xy_m"]["median"], 1.0);
  EXPECT_EQ(report["poses"].size(), 2U);
  EXPECT_EQ(report["success"][1]["rate"], 1.0);
}

TEST_F(Evaluate, WithoutAnyEstimateTheStatisticsAreNull) {
  std::ofstream(folder_ / "lost.txt") << "nan nan nan nan nan nan nan nan nan nan nan nan\n";
  const CommandResult result = run_vdbmap({"evaluate", folder_ / "lost.txt", poses_file("truth.txt", 1), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["num_missing"], 1);
  EXPECT_TRUE(report["xy_m"]["median"].is_null());
  EXPECT_TRUE(report["poses"][0].is_null());
}

TEST_F(Evaluate, LengthsThatDoNotAgreeAreBadInput) {
  const CommandResult result =
      run_vdbmap({"evaluate", poses_file("estimate.txt", 3), poses_file("truth.txt", 4), "--every", "2"});
  expect_one_line_error(result, ExitCode::kBadInput);
  EXPECT_NE(result.err.find("truth.txt: 4 poses"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("3 are needed"), std::string::npos) << result.err;
}

TEST_F(Evaluate, BadAndMissingFilesHaveTheirOwnCodes) {
  const std::string good = poses_file("good.txt", 2);
  std::ofstream(folder_ / "bad.txt") << "1 2 3\n";
  expect_one_line_error(run_vdbmap({"evaluate", folder_ / "bad.txt", good}), ExitCode::kBadInput);
  expect_one_line_error(run_vdbmap({"evaluate", good, folder_ / "missing.txt"}), ExitCode::kInputOutputFailed);
  expect_one_line_error(run_vdbmap({"evaluate", good, folder_.path()}), ExitCode::kInputOutputFailed);
  expect_one_line_error(run_vdbmap({"evaluate", good, folder_ / "line\nbreak\x1b"}), ExitCode::kInputOutputFailed);
}

TEST_F(Evaluate, AFullDiskOnStdoutIsAnError) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  if (full < 0) GTEST_SKIP() << "no /dev/full";
  const std::string poses = poses_file("poses.txt", 2);
  expect_one_line_error(run_vdbmap({"evaluate", poses, poses}, {.out_descriptor = full}), ExitCode::kInputOutputFailed);
  expect_one_line_error(run_vdbmap({"--help"}, {.out_descriptor = full}), ExitCode::kInputOutputFailed);
  ::close(full);
}

TEST_F(Evaluate, APipeThatNobodyReadsIsAnError) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  ::close(ends[0]);
  const std::string poses = poses_file("poses.txt", 2);
  expect_one_line_error(run_vdbmap({"evaluate", poses, poses}, {.out_descriptor = ends[1]}),
                        ExitCode::kInputOutputFailed);
  ::close(ends[1]);
}

TEST_F(Evaluate, SignalsEndItWithTheirCode) {
  const std::string fifo = folder_ / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Once the pipe can be opened for writing, the command waits in it for its first byte.
    const auto interrupt = [&](pid_t process) {
      int writer = -1;
      for (int i = 0; i < 1000 && writer < 0; ++i) {
        writer = ::open(fifo.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      ::kill(process, signal);
      ::close(writer);
    };
    const CommandResult result = run_vdbmap({"evaluate", fifo, fifo}, {.while_running = interrupt});
    EXPECT_EQ(result.exit_code, 128 + signal) << result.err;
  }
}

}  // namespace
}  // namespace vdbmap::cli
