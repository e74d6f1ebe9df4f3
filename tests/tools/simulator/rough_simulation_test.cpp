// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation that is not ideal, whole.
#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/folders.h"
#include "tests/support/pose_distance.h"
#include "tests/support/raw_files.h"
#include "tests/support/threads.h"
#include "tools/simulator/simulate.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::simulator {
namespace {

using std::filesystem::path;

SimulateOptions two_surveys() {
  SimulateOptions options;
  options.street.seed = 4;
  options.street.length = 40;
  options.street.margin = 20;
  options.sensors = parse_sensors("mapper,vlp16@1");
  options.num_scans = 4;
  return options;
}

class RoughSimulation : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    simulate(out(), two_surveys());
    street_ = nlohmann::json::parse(test::read_raw(out() / "street.json"));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static path out() { return *folder_ / "street"; }

  static Trajectory poses(const char* name) { return read_trajectory(out() / name); }

  static inline std::unique_ptr<test::TemporaryFolder> folder_;
  static inline nlohmann::json street_;
};

TEST_F(RoughSimulation, LabelsTellWhatMovesAndTheListOfObjectsAgrees) {
  std::set<int> moving;
  for (const nlohmann::json& object : street_["objects"]) {
    if (object.value("moves", false)) moving.insert(object["id"].get<int>());
  }
  EXPECT_GE(moving.size(), 5U);
  std::size_t num_moving_points = 0;
  for (const char* name :
       {"epoch0/labels/cloud.label", "epoch1/labels/cloud.label", "epoch1/labels/scans/000002.label"}) {
    const auto labels = read_labels(out() / name);
    for (const PointLabel& label : labels) {
      const bool has_moving_class = label.label >= 252;
      // Prams and dogs have no moving class.
      const bool has_none = label.label == 99;
      ASSERT_TRUE(has_none || has_moving_class == moving.contains(label.object)) << label.label;
      num_moving_points += has_moving_class ? 1 : 0;
    }
  }
  EXPECT_GT(num_moving_points, 500U);
}

TEST_F(RoughSimulation, MoversAreWhereTheirPointsAre) {
  // The mean of each mover's points lies within its way, whose places are those of the file, less than 10 m long
  // bodies.
  std::map<int, Eigen::AlignedBox2d> ways;
  std::ifstream stream(out() / "epoch0" / "movers_mapper.csv");
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "object,kind,time,x,y,z,heading");
  while (std::getline(stream, line)) {
    std::istringstream words(line);
    std::string object, kind, time, x, y;
    std::getline(words, object, ',');
    std::getline(words, kind, ',');
    std::getline(words, time, ',');
    std::getline(words, x, ',');
    std::getline(words, y, ',');
    ways[std::stoi(object)].extend(Eigen::Vector2d(std::stod(x), std::stod(y)));
  }
  const PointCloud cloud = read_points(out() / "epoch0" / "cloud.las").cloud;
  const auto labels = read_labels(out() / "epoch0" / "labels" / "cloud.label");
  ASSERT_EQ(labels.size(), cloud.size());
  std::size_t num_checked = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (labels[i].label < 252) continue;
    ASSERT_TRUE(ways.contains(labels[i].object));
    ASSERT_LT(ways[labels[i].object].exteriorDistance(Eigen::Vector2d(cloud.positions[i].head<2>())), 7.5);
    ++num_checked;
  }
  EXPECT_GT(num_checked, 100U);
}

TEST_F(RoughSimulation, SurveysErrByCentimetresAndEachInItsOwnWay) {
  const Trajectory really = poses("epoch0/mapper.tum"), believed = poses("epoch0/mapper_estimated.tum");
  ASSERT_EQ(really.size(), believed.size());
  double farthest = 0;
  for (std::size_t i = 0; i < really.size(); ++i) {
    farthest =
        std::max(farthest, test::distance_between(*really.map_from_scan[i], *believed.map_from_scan[i]).translation);
  }
  EXPECT_GT(farthest, 0.003);
  EXPECT_LT(farthest, 0.06);
  ASSERT_EQ(street_["surveys"].size(), 3U);
  EXPECT_NE(street_["surveys"][0]["error"], street_["surveys"][1]["error"]);
  EXPECT_EQ(street_["surveys"][2]["scanner"]["errors"]["range_bias"].size(), 16U);
}

// Where a survey has a scan is where the mapper's error puts it: not farther off than the error of the trajectory and
// of what hangs on it.
TEST_F(RoughSimulation, ScansHaveAPoseInTheFrameOfEachSurvey) {
  const Trajectory really = poses("epoch1/poses.txt");
  for (const char* name : {"epoch1/poses_in_survey0.txt", "epoch1/poses_in_survey1.txt"}) {
    const Trajectory in_survey = poses(name);
    ASSERT_EQ(in_survey.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto distance = test::distance_between(*really.map_from_scan[i], *in_survey.map_from_scan[i]);
      EXPECT_GT(distance.translation, 0.001);
      EXPECT_LT(distance.translation, 0.07);
      EXPECT_LT(distance.rotation_deg, 0.1);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(out() / "epoch1" / "poses_in_survey2.txt"));
}

TEST_F(RoughSimulation, SpacesKnowWhatBlocksThemAndWhoSawThem) {
  const nlohmann::json spaces = nlohmann::json::parse(test::read_raw(out() / "spaces.geojson"));
  ASSERT_FALSE(spaces["features"].empty());
  double best = 0;
  for (const nlohmann::json& space : spaces["features"]) {
    const nlohmann::json& properties = space["properties"];
    ASSERT_EQ(properties["visibility"].size(), 3U);  // two mappers and the scanner
    for (const nlohmann::json& drive : properties["visibility"]) {
      EXPECT_GE(drive["share"], 0.0);
      EXPECT_LE(drive["share"], 1.0);
      best = std::max(best, drive["share"].get<double>());
    }
    for (const std::size_t epoch : {0, 1}) {
      if (!properties["blocked_by"][epoch].is_null()) {
        EXPECT_EQ(properties["states"][epoch], "vacant");
      }
    }
  }
  EXPECT_GT(best, 0.5);
}

TEST_F(RoughSimulation, SameSeedGivesSameBytesForAnyNumberOfThreads) {
  SimulateOptions options = two_surveys();
  options.street.margin = 5;
  options.sensors = parse_sensors("mapper@0,vlp16@1");
  options.num_scans = 2;
  const auto bytes_of = [&](int threads) {
    const test::TemporaryFolder other;
    test::on_threads(threads, [&] { return simulate(other / "street", options); });
    std::map<std::string, std::string> bytes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(other / "street")) {
      if (!entry.is_regular_file()) continue;
      bytes[std::filesystem::relative(entry.path(), other / "street")] = test::read_raw(entry.path());
    }
    return bytes;
  };
  EXPECT_TRUE(bytes_of(1) == bytes_of(2));
}

}  // namespace
}  // namespace vdbmap::simulator
