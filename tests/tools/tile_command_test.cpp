// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/city_folders.h"
#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "tools/cli/number_ranges.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;

// Two surveys in the tiles 0_0 to 2_0, anchored at the origin.
class TileCommandTest : public MapCommand {
 protected:
  void SetUp() override {
    ply("survey/a.ply", moved(scan(1), {60, 32, 3}));
    ply("survey/b.ply", moved(scan(2), {124, 30, 3}));
  }

  std::string ply(const std::string& name, const PointCloud& cloud) const {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    return MapCommand::ply(name, cloud);
  }

  CommandResult plan(const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments = {"tile", "plan", path("survey"), "-o", path("city/"), "--anchor", "0,0,0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return vdbmap(arguments);
  }

  CommandResult tile(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "tile");
    return vdbmap(arguments);
  }

  std::string job() const { return path("city.job"); }

  void expect_built() const {
    build({path("survey")}, "built/", {"--anchor", "0,0,0"});
    EXPECT_TRUE(test::files_of_city(path("built")) == test::files_of_city(path("city")));
  }
};

using TileCommand = TileCommandTest;

TEST(NumberRanges, AreThoseOfJobArrays) {
  EXPECT_EQ(parse_ranges("3"), (std::vector<std::size_t>{3}));
  EXPECT_EQ(parse_ranges("0-2,7,9-10"), (std::vector<std::size_t>{0, 1, 2, 7, 9, 10}));
  EXPECT_EQ(ranges_text({0, 1, 2, 7, 9, 10}), "0-2,7,9-10");
  EXPECT_EQ(ranges_text({}), "");
  for (const char* text : {"", "a", "1,", ",1", "2-1", "-1", "1-", "1-2-3", "0-99999999999", "1 2"}) {
    EXPECT_THROW(parse_ranges(text), std::invalid_argument) << text;
  }
}

TEST_F(TileCommand, StagesOneByOneMakeTheCity) {
  EXPECT_EQ(plan({"--buckets", "2"}).out, job() + ": 2 sources, 0.00 GB, to be finished in 2 buckets\n");
  EXPECT_EQ(tile({"status", job(), "--missing", "map"}).out, "0-1\n");
  EXPECT_EQ(tile({"map", job(), "1"}).out, "source 1, b.ply: mapped\n");
  EXPECT_EQ(tile({"map", job(), "0-1"}).out, "source 0, a.ply: mapped\nsource 1, b.ply: was mapped before\n");
  EXPECT_EQ(tile({"status", job(), "--missing", "map"}).out, "\n");
  EXPECT_EQ(tile({"status", job(), "--missing", "reduce"}).out, "0-1\n");
  EXPECT_EQ(tile({"reduce", job(), "1"}).out, "bucket 1: finished\n");
  expect_error(tile({"finish", job()}), ExitCode::kBadInput, "tiles/0: is missing: bucket 0 is not reduced yet");
  EXPECT_EQ(tile({"reduce", job(), "0-1"}).out, "bucket 0: finished\nbucket 1: was finished before\n");
  EXPECT_NE(tile({"finish", job()}).out.find("published, 2 sources added\npoints     10000\n"), std::string::npos);
  expect_built();
  const json status = json_of({"tile", "status", job()});
  EXPECT_TRUE(status["is_published"]);
  EXPECT_TRUE(status["problem"].is_null());
  EXPECT_EQ(status["missing_buckets"].size(), 0U);
}

TEST_F(TileCommand, ARunMakesTheCityOnce) {
  EXPECT_EQ(plan().exit_code, 0);
  const json first = json_of({"tile", "run", job(), "--jobs", "3", "--memory", "1M"});
  EXPECT_EQ(first["added_sources"], 2);
  EXPECT_EQ(first["was_published"], false);
  expect_built();
  EXPECT_EQ(json_of({"tile", "run", job()})["was_published"], true);
  expect_built();
}

TEST_F(TileCommand, ABadSourceIsNamed) {
  test::write_raw(path("survey/bad.ply"), "ply\nformat ascii 1.0\nelement vertex\n");
  EXPECT_EQ(plan().exit_code, 0);
  expect_error(tile({"run", job()}), ExitCode::kBadInput, "bad.ply:3: ");
  const CommandResult skipping = tile({"run", job(), "--skip-bad"});
  EXPECT_EQ(skipping.exit_code, 0) << skipping.err;
  EXPECT_NE(skipping.err.find("left out: " + path("survey/bad.ply")), std::string::npos) << skipping.err;
  EXPECT_NE(tile({"status", job()}).out.find("left out   " + path("survey/bad.ply")), std::string::npos);
  std::filesystem::remove(path("survey/bad.ply"));
  expect_built();
}

TEST_F(TileCommand, WhatIsWrongIsToldInOneLine) {
  expect_error(tile({"no-such-stage"}), ExitCode::kWrongUsage, "no command 'no-such-stage', see vdbmap tile --help");
  expect_error(tile({}), ExitCode::kWrongUsage, "no command given, see vdbmap tile --help");
  expect_error(vdbmap({"tile", "plan", path("survey")}), ExitCode::kWrongUsage, "--output or --into is required");
  expect_error(tile({"map", path("none"), "0"}), ExitCode::kInputOutputFailed, "none: cannot open");
  expect_error(tile({"map", path("survey"), "0"}), ExitCode::kBadInput, "survey: is no job: it has no job.json");
  EXPECT_EQ(plan().exit_code, 0);
  expect_error(plan({"--epoch", "2"}), ExitCode::kWrongUsage, "holds another plan");
  expect_error(tile({"map", job(), "2"}), ExitCode::kWrongUsage, "has no source 2, but 2 from 0 on");
  expect_error(tile({"map", job(), "two"}), ExitCode::kWrongUsage, "'two' are no numbers");
  expect_error(tile({"reduce", job(), "0"}), ExitCode::kBadInput, "0.part: is missing: source 0 is not mapped yet");
  expect_error(tile({"submit", job()}), ExitCode::kWrongUsage, "--slurm is required");
  std::filesystem::rename(path("survey/a.ply"), path("away.ply"));
  expect_error(tile({"map", job(), "0", "--skip-bad"}), ExitCode::kInputOutputFailed, "a.ply: cannot open");
  EXPECT_EQ(json_of({"tile", "status", job()})["left_out"].size(), 0U);
  test::write_raw(path("city.job/job.json"), "{}");
  expect_error(tile({"status", job()}), ExitCode::kBadInput, "job.json: format is missing");
}

TEST_F(TileCommand, WhatIsSubmittedIsWhatIsLeftToDo) {
  EXPECT_EQ(plan({"--buckets", "3"}).exit_code, 0);
  const auto printed = [&](std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"submit", job(), "--slurm", "--print"});
    return tile(options).out;
  };
  const std::string all = printed({"--task-size", "1", "--sbatch=--partition=long", "--skip-bad", "--threads", "2"});
  EXPECT_NE(all.find("numbers=(0 1)\n"), std::string::npos) << all;
  EXPECT_NE(all.find("numbers=(0 1 2)\n"), std::string::npos) << all;
  EXPECT_NE(all.find(" --skip-bad --threads 2\n"), std::string::npos) << all;
  EXPECT_NE(all.find("--array=0-1 --partition=long"), std::string::npos) << all;
  EXPECT_NE(all.find("--dependency=afterok:JOB_OF_map --kill-on-invalid-dep=yes"), std::string::npos) << all;
  EXPECT_NE(all.find("--dependency=afterok:JOB_OF_reduce"), std::string::npos) << all;
  EXPECT_NE(printed().find("numbers=(0-1)\n"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("city.job/slurm")));

  EXPECT_EQ(tile({"map", job(), "0-1"}).exit_code, 0);
  EXPECT_EQ(tile({"reduce", job(), "1"}).exit_code, 0);
  const std::string rest = printed();
  EXPECT_EQ(rest.find("tile map"), std::string::npos);
  EXPECT_NE(rest.find("numbers=(0 2)\n"), std::string::npos) << rest;
  EXPECT_EQ(tile({"run", job()}).exit_code, 0);
  EXPECT_EQ(printed(), "nothing is left to do\n");
}

// In place of Slurm's sbatch: writes down what it is told, and says the number of a job.
TEST_F(TileCommand, StagesAreSubmittedEachAfterTheOneBefore) {
  EXPECT_EQ(plan().exit_code, 0);
  const auto submit = [&](const std::string& folders) {
    return test::run_command("/usr/bin/env", {"PATH=" + folders, VDBMAP_COMMAND, "tile", "submit", job(), "--slurm"});
  };
  expect_error(submit(path("none")), ExitCode::kInputOutputFailed, "sbatch: cannot be run: No such file");
  std::filesystem::create_directory(path("bin"));
  const auto write_sbatch = [&](const std::string& body) {
    test::write_raw(path("bin/sbatch"), "#!/bin/sh\n" + body);
    std::filesystem::permissions(path("bin/sbatch"), std::filesystem::perms::owner_all);
  };
  write_sbatch("echo no such partition; exit 1\n");
  expect_error(submit(path("bin")), ExitCode::kInputOutputFailed, "sbatch: failed, saying 'no such partition'");
  write_sbatch("echo \"$*\" >> " + path("told") + "\nread n < " + path("told") + "\necho \"4${#n};cluster\"\n");
  const CommandResult submitted = submit(path("bin"));
  const std::string told = test::read_raw(path("told"));
  const std::string number = "4" + std::to_string(told.find('\n'));
  EXPECT_EQ(submitted.out,
            "map        job " + number + "\nreduce     job " + number + "\nfinish     job " + number + "\n");
  EXPECT_EQ(num_lines(told), 3U) << told;
  EXPECT_EQ(told.find("--dependency"), told.find("--dependency=afterok:" + number + " --kill-on-invalid-dep=yes"));
  EXPECT_NE(told.find("/city.job/slurm/finish.sh\n"), std::string::npos) << told;
  EXPECT_NE(test::read_raw(path("city.job/slurm/map.sh")).find("tile map"), std::string::npos);
}

// Words of the shell in names are names.
TEST_F(TileCommand, ScriptsQuoteWhatTheyName) {
  const std::string odd = path("it's $(touch x) city");
  EXPECT_EQ(vdbmap({"tile", "plan", path("survey"), "-o", odd + "/"}).exit_code, 0);
  const std::string script = vdbmap({"tile", "submit", odd + ".job", "--slurm", "--print"}).out;
  EXPECT_NE(script.find("tile map '" + path("it'\\''s $(touch x) city.job") + "' \"${numbers"), std::string::npos)
      << script;
  EXPECT_NE(script.find(" '" + path("it'\\''s $(touch x) city.job/slurm/map.sh") + "'\n"), std::string::npos) << script;
}

// One source in one tile: every call of all stages is met, in as short a time as can be.
class TileFaultTest : public TileCommandTest {
 protected:
  void SetUp() override {
    ply("survey/a.ply", moved(scan(1), {32, 32, 3}));
    EXPECT_EQ(plan({"--buckets", "1"}).exit_code, 0);
    std::filesystem::copy(job(), path("planned"), std::filesystem::copy_options::recursive);
  }

  void begin_anew() const {
    std::filesystem::remove_all(path("city"));
    std::filesystem::remove_all(job());
    std::filesystem::copy(path("planned"), job(), std::filesystem::copy_options::recursive);
  }

  CommandResult run() const { return tile(run_arguments()); }

  CommandResult run_with(const std::string& fault) const {
    std::vector<std::string> arguments = {"LD_PRELOAD=" VDBMAP_FAULT, fault, VDBMAP_COMMAND, "tile"};
    for (const std::string& argument : run_arguments()) arguments.push_back(argument);
    return test::run_command("/usr/bin/env", arguments);
  }

 private:
  std::vector<std::string> run_arguments() const { return {"run", job(), "--memory", "1M", "--threads", "1"}; }
};

using TileFault = TileFaultTest;

TEST_F(TileFault, KilledAtAnyCallTheSameCommandGivesTheSameBytes) {
  build({path("survey")}, "built/", {"--anchor", "0,0,0"});
  const auto expected = test::files_of_city(path("built"));
  int num_kills = 0;
  for (int n = 1; n < 2000; ++n) {
    begin_anew();
    if (run_with("VDBMAP_KILL_AT=" + std::to_string(n)).signal == 0) break;
    ++num_kills;
    const CommandResult again = run();
    ASSERT_EQ(again.exit_code, 0) << n << again.err;
    ASSERT_TRUE(test::files_of_city(path("city")) == expected) << n;  // _EQ would print all bytes
  }
  EXPECT_GT(num_kills, 20);
}

TEST_F(TileFault, AFullDiskIsOneLineAndNothingIsPublished) {
  int num_failures = 0;
  for (int n = 1; n < 2000; ++n) {
    begin_anew();
    const CommandResult failed = run_with("VDBMAP_FULL_AT=" + std::to_string(n));
    if (failed.exit_code == 0) break;
    ++num_failures;
    ASSERT_EQ(failed.exit_code, 4) << n << failed.err;
    ASSERT_EQ(num_lines(failed.err), 1U) << n << failed.err;
    ASSERT_FALSE(std::filesystem::exists(path("city"))) << n;
  }
  EXPECT_GT(num_failures, 5);
}

}  // namespace
}  // namespace vdbmap::cli
