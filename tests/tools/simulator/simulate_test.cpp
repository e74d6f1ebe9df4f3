// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/simulate.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/folders.h"
#include "tests/support/pose_distance.h"
#include "tests/support/raw_files.h"
#include "tests/support/threads.h"
#include "tools/simulator/material.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/atomic_file.h"
#include "vdbmap/io/kitti/label_file.h"
#include "vdbmap/io/points/point_reader.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::simulator {
namespace {

using std::filesystem::path;

SimulateOptions short_street() {
  SimulateOptions options;
  options.street.length = 30;
  options.street.margin = 10;
  options.street.occupancy = 1;
  options.street.is_ideal = true;
  options.num_scans = 3;
  return options;
}

nlohmann::json read_json(const path& file) { return nlohmann::json::parse(test::read_raw(file)); }

struct Box {
  Eigen::Vector3d center, size;
  double heading, pitch, roll;

  // How far outside the box a point is, along its axes.
  Eigen::Vector3d excess(const Eigen::Vector3d& point) const {
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    return (rotation.transpose() * (point - center)).cwiseAbs() - size / 2;
  }
};

std::map<int, Box> read_vehicles(const path& file) {
  std::map<int, Box> boxes;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "id,body,x,y,z,length,width,height,heading,pitch,roll,space");
  while (std::getline(stream, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    int id = 0;
    std::string body;
    Box box;
    words >> id >> body >> box.center.x() >> box.center.y() >> box.center.z() >> box.size.x() >> box.size.y() >>
        box.size.z() >> box.heading >> box.pitch >> box.roll;
    EXPECT_FALSE(words.fail()) << line;
    boxes[id] = box;
  }
  return boxes;
}

// One simulation for all tests that only look at it.
class Simulation : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    result_ = simulate(out(), short_street());
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static path out() { return *folder_ / "street"; }
  static path scan_file(int index) { return out() / "epoch1" / "scans" / ("00000" + std::to_string(index) + ".pcd"); }

  static inline std::unique_ptr<test::TemporaryFolder> folder_;
  static inline SimulateResult result_;
};

TEST_F(Simulation, WritesTheFilesItPromises) {
  for (const char* name :
       {"street.json", "spaces.geojson", "changes.csv", "epoch0/cloud.las", "epoch0/mapper.tum", "epoch0/vehicles.csv",
        "epoch0/labels/cloud.label", "epoch1/scans/000002.pcd", "epoch1/labels/scans/000002.label", "epoch1/poses.txt",
        "epoch1/poses.tum", "epoch1/vehicles.csv"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(out() / name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(out() / "epoch0" / "scans"));
  EXPECT_FALSE(std::filesystem::exists(out() / "epoch1" / "cloud.las"));
}

TEST_F(Simulation, CloudIsColouredAndInUtmZone32) {
  const ReadResult cloud = read_points(out() / "epoch0" / "cloud.las");
  EXPECT_EQ(cloud.epsg, 25832);
  EXPECT_EQ(cloud.cloud.size(), result_.epochs[0].num_cloud_points);
  EXPECT_EQ(cloud.cloud.colors.size(), cloud.cloud.size());
  EXPECT_GT(cloud.cloud.size(), 400'000U);
  for (std::size_t i = 0; i < cloud.cloud.size(); i += 1001) {
    const Eigen::Vector3d& p = cloud.cloud.positions[i];
    EXPECT_TRUE(p.x() > 547'500 && p.x() < 553'500 && p.y() > 5'800'500 && p.y() < 5'806'500) << p.transpose();
  }
}

TEST_F(Simulation, ScansHaveRingsTimesAndAbout25000Points) {
  const PointCloud scan = read_points(scan_file(1)).cloud;
  EXPECT_GT(scan.size(), 20'000U);
  EXPECT_LE(scan.size(), 28'800U);
  EXPECT_EQ(*std::ranges::max_element(scan.rings), 15);
  EXPECT_TRUE(std::ranges::is_sorted(scan.times));
}

TEST_F(Simulation, KittiAndTumPosesAgreeAndHoldAtTheFirstPoint) {
  const Trajectory kitti = read_trajectory(out() / "epoch1" / "poses.txt");
  const Trajectory tum = read_trajectory(out() / "epoch1" / "poses.tum");
  ASSERT_EQ(kitti.size(), 3U);
  ASSERT_EQ(tum.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const auto distance = test::distance_between(*kitti.map_from_scan[index], *tum.map_from_scan[index]);
    EXPECT_LT(distance.translation, 1e-8);
    EXPECT_LT(distance.rotation_deg, 1e-6);
    EXPECT_EQ(tum.times[index], read_points(scan_file(i)).cloud.times.front());
  }
}

TEST_F(Simulation, LabelsCountAsManyAsPoints) {
  EXPECT_EQ(read_labels(out() / "epoch0" / "labels" / "cloud.label").size(), result_.epochs[0].num_cloud_points);
  EXPECT_EQ(read_labels(out() / "epoch1" / "labels" / "scans" / "000001.label").size(),
            read_points(scan_file(1)).cloud.size());
}

// Points of a car lie in its box but for mirrors (14 cm), trim (8 mm) and five times the noise of 5 mm.
TEST_F(Simulation, PointsOfVehiclesLieInTheirBoxes) {
  const PointCloud cloud = read_points(out() / "epoch0" / "cloud.las").cloud;
  const std::vector<PointLabel> truth = read_labels(out() / "epoch0" / "labels" / "cloud.label");
  const std::map<int, Box> boxes = read_vehicles(out() / "epoch0" / "vehicles.csv");
  std::map<int, int> num_points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (truth[i].label != static_cast<std::uint16_t>(SurfaceClass::kCar)) continue;
    const Eigen::Vector3d excess = boxes.at(truth[i].object).excess(cloud.positions[i]);
    ASSERT_LT(excess.x(), 0.035);
    ASSERT_LT(excess.y(), 0.17);
    ASSERT_LT(excess.z(), 0.03);
    ++num_points[truth[i].object];
  }
  EXPECT_EQ(num_points.size(), boxes.size());
}

TEST_F(Simulation, SpacesKnowTheVehiclesOfEveryEpoch) {
  const nlohmann::json spaces = read_json(out() / "spaces.geojson");
  EXPECT_EQ(spaces["features"].size(), result_.num_spaces);
  for (const std::size_t epoch : {0, 1}) {
    const auto vehicles = read_vehicles(out() / ("epoch" + std::to_string(epoch)) / "vehicles.csv");
    std::size_t num_occupied = 0;
    for (const nlohmann::json& space : spaces["features"]) {
      const nlohmann::json& properties = space["properties"];
      const bool is_occupied = properties["states"][epoch] == "occupied";
      EXPECT_EQ(is_occupied, !properties["vehicles"][epoch].is_null());
      if (!is_occupied) continue;
      ++num_occupied;
      // The middle of the space lies under the vehicle.
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (int i = 0; i < 4; ++i) {
        const auto& corner = space["geometry"]["coordinates"][0][static_cast<std::size_t>(i)];
        middle += Eigen::Vector2d(corner[0], corner[1]) / 4;
      }
      const Box& box = vehicles.at(properties["vehicles"][epoch]);
      EXPECT_LT((box.center.head<2>() - middle).norm(), 0.8);
    }
    EXPECT_EQ(num_occupied, vehicles.size());
    EXPECT_EQ(num_occupied, result_.epochs[epoch].num_vehicles);
  }
}

TEST_F(Simulation, SameSeedGivesSameBytesForAnyNumberOfThreads) {
  const auto bytes_of = [](const path& folder) {
    std::map<std::string, std::string> bytes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) {
        bytes[std::filesystem::relative(entry.path(), folder)] = test::read_raw(entry.path());
      }
    }
    return bytes;
  };
  for (const int threads : {1, 2}) {
    const test::TemporaryFolder other;
    test::on_threads(threads, [&] { return simulate(other / "street", short_street()); });
    EXPECT_TRUE(bytes_of(out()) == bytes_of(other / "street")) << threads << " threads";
  }
}

TEST(SimulateOptions, ParsesSensorsWithAndWithoutTheirEpoch) {
  const std::vector<SensorUse> uses = parse_sensors("mapper,hdl64@3");
  ASSERT_EQ(uses.size(), 2U);
  EXPECT_TRUE(uses[0].sensor.is_mapper());
  EXPECT_FALSE(uses[0].epoch);
  EXPECT_EQ(uses[1].sensor.name, "hdl64");
  EXPECT_EQ(uses[1].epoch, 3);
  for (const char* text : {"", "radar", "vlp16,", "vlp16@", "vlp16@x", "vlp16@-1", "vlp16@1@2", "@1"}) {
    EXPECT_THROW(parse_sensors(text), std::invalid_argument) << text;
  }
}

TEST(SimulateOptions, RefusesScansAndEpochsThatCannotBe) {
  SimulateOptions options;
  options.num_scans = 0;
  EXPECT_THROW(options.check(), std::invalid_argument);
  options = {};
  options.sensors = parse_sensors("vlp16@2");
  EXPECT_THROW(options.check(), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::simulator
