// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"

namespace vdbmap::cli {
namespace {

using test::write_raw;

class SimulateCommand : public testing::Test {
 protected:
  std::string out() const { return folder_ / "street"; }

  std::size_t num_entries() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_.path()), std::filesystem::directory_iterator()));
  }

  std::vector<std::string> quick(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"simulate", out(), "--ideal", "--length", "30",
                                          "--margin", "5",   "--scans", "1"};
    if (std::ranges::find(more, "--sensors") == more.end()) more.insert(more.end(), {"--sensors", "vlp16@0"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SimulateCommand, RefusesWrongOptionsInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> refused = {
      {{"--length", "0"}, "street length 0 m, allowed are 30 to 1000 m"},
      {{"--length", "1e9"}, "street length"},
      {{"--length", "nan"}, "street length nan"},
      {{"--epochs", "0"}, "number of epochs 0, allowed are 1 to 20"},
      {{"--seed", "-1"}, "--seed: is -1, expected a whole number from 0 on"},
      {{"--scans", "0"}, "number of scans 0"},
      {{"--sensors", "radar"}, "unknown sensor 'radar'"},
      {{"--sensors", "vlp16@7"}, "there are epochs 0 to 1"},
      {{"--occupancy", "2"}, "occupancy 2"},
      {{"--rain", "-1"}, "rain -1 mm/h, allowed are 0 to 50 mm/h"},
      {{"--rain", "5", "--ideal"}, "on an ideal street no rain falls"},
      {{"--quarter", "3"}, "--quarter '3' is not of the form 3x2"},
      {{"--quarter", "0x2"}, "allowed are 1 to 6"},
      {{"--quarter", "9x2"}, "columns of the quarter 9, allowed are 1 to 6"},
      {{"--quarter", "2x2", "--ideal"}, "a quarter is never ideal"},
  };
  for (const auto& [options, part] : refused) {
    std::vector<std::string> arguments = {"simulate", out()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_error(vdbmap(arguments), ExitCode::kWrongUsage, part);
  }
  EXPECT_EQ(num_entries(), 0U);
}

TEST_F(SimulateCommand, DoesNotTouchFoldersOfOthers) {
  std::filesystem::create_directory(out());
  write_raw(out() + "/thesis.txt", "ten years of work");
  expect_error(vdbmap(quick()), ExitCode::kBadInput, "holds 'thesis.txt', which no simulation wrote");
  EXPECT_EQ(test::read_raw(out() + "/thesis.txt"), "ten years of work");
  EXPECT_EQ(num_entries(), 1U);
}

TEST_F(SimulateCommand, DoesNotReplaceWhatOnlyLooksLikeASimulation) {
  std::filesystem::create_directory(out());
  write_raw(out() + "/street.json", "{\"name\": \"Main Street\"}");
  expect_error(vdbmap(quick()), ExitCode::kBadInput, "is not an earlier simulation");
}

TEST_F(SimulateCommand, SaysWhereItCannotWrite) {
  expect_error(vdbmap({"simulate", folder_ / "missing" / "street"}), ExitCode::kInputOutputFailed, "cannot create");
  write_raw(out(), "a file");
  expect_error(vdbmap(quick()), ExitCode::kInputOutputFailed, "cannot create the folder");
}

TEST_F(SimulateCommand, ReplacesAnEarlierSimulation) {
  ASSERT_EQ(vdbmap(quick()).exit_code, 0);
  const std::string first = test::read_raw(out() + "/street.json");
  const test::CommandResult again = vdbmap(quick({"--seed", "2"}));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("street of 30 m, seed 2"), std::string::npos) << again.out;
  EXPECT_NE(test::read_raw(out() + "/street.json"), first);
  EXPECT_EQ(num_entries(), 1U);
}

TEST_F(SimulateCommand, LeavesNothingWhenInterrupted) {
  test::RunOptions options;
  options.while_running = [this](pid_t child) {
    // Not before there is something to remove.
    for (int i = 0; i < 2000 && num_entries() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(child, SIGINT);
  };
  const auto result = test::run_command(VDBMAP_COMMAND, {"simulate", out(), "--length", "300"}, options);
  EXPECT_EQ(result.exit_code, 128 + SIGINT);
  EXPECT_EQ(num_entries(), 0U);
}

TEST_F(SimulateCommand, TakesScannersOfAFile) {
  const std::string file = folder_ / "sensors.json";
  write_raw(file, R"([{"name": "tiny", "beams": 4, "firings": 360, "epoch": 0}])");
  const auto result = vdbmap(quick({"--sensors", file}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(out() + "/epoch0/scans_tiny/000000.pcd"));
  EXPECT_TRUE(std::filesystem::exists(out() + "/epoch0/poses_tiny.txt"));
  write_raw(file, "[{}]");
  expect_error(vdbmap(quick({"--sensors", file})), ExitCode::kBadInput, "sensors.json: sensor 0 wants a text");
}

}  // namespace
}  // namespace vdbmap::cli
