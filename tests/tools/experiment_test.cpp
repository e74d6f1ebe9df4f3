// SPDX-License-Identifier: GPL-3.0-or-later
// tools/experiment.sh on a street of 60 m and 20 scans: all commands of the pipeline, one after the other.
#include "tests/tools/map_command.h"

namespace vdbmap::cli {
namespace {

class Experiment : public MapCommand {};

TEST_F(Experiment, ScansOfAnotherDayAreFoundInTheMapOfTheFirst) {
  const std::string street = path("street");
  const std::string map = path("map.vdb");
  const std::string poses = path("poses.txt");
  json_of({"simulate", street, "--ideal", "--length", "60", "--margin", "30", "--scans", "20"});
  json_of({"build", street + "/epoch0/cloud.las", "-o", map});
  EXPECT_EQ(json_of({"localize", map, street + "/epoch1/scans", "-o", poses})["found"], 20);

  // The bounds of the whole experiment, which repeats section 3 of Mortazavi et al. (2023).
  const auto errors = json_of({"evaluate", poses, street + "/epoch1/poses.txt"});
  EXPECT_EQ(errors["num_missing"], 0);
  EXPECT_LT(errors["xy_m"]["median"], 0.015);
  EXPECT_LT(errors["xy_m"]["max"], 0.05);
  EXPECT_LT(errors["z_m"]["max"], 0.03);
}

// On a street that is not ideal the map errs as its survey did: what is found is compared with where the survey has it.
TEST_F(Experiment, ScansAreFoundInTheFrameOfASurveyThatErrs) {
  const std::string street = path("street");
  const std::string map = path("map.vdb");
  const std::string poses = path("poses.txt");
  json_of({"simulate", street, "--seed", "3", "--length", "60", "--margin", "30", "--scans", "20"});
  json_of({"build", street + "/epoch0/cloud.las", "-o", map});
  EXPECT_EQ(json_of({"localize", map, street + "/epoch1/scans", "-o", poses})["found"], 20);

  const auto errors = json_of({"evaluate", poses, street + "/epoch1/poses_in_survey0.txt"});
  EXPECT_EQ(errors["num_missing"], 0);
  EXPECT_LT(errors["xy_m"]["median"], 0.015);
  EXPECT_LT(errors["xy_m"]["max"], 0.05);
  EXPECT_LT(errors["z_m"]["max"], 0.04);
}

}  // namespace
}  // namespace vdbmap::cli
