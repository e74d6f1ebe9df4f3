// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/sensor_file.h"

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap::simulator {
namespace {

std::vector<SensorUse> read(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_raw(folder / "sensors.json", text);
  return read_sensors(folder / "sensors.json");
}

TEST(SensorFile, ReadsScannersOfNamedModelsAndOfTheirOwn) {
  const auto uses = read(R"([{"name": "roof", "model": "hdl32", "epoch": 1, "height": 2.1, "tilt_deg": 30},
                             {"name": "five", "elevations_deg": [3, -20, 0], "rate": 20, "firings": 900, "range": 80,
                              "noise": 0.02}, {"name": "many", "beams": 128, "lowest_deg": -25, "highest_deg": 15}])");
  ASSERT_EQ(uses.size(), 3U);
  EXPECT_EQ(uses[0].sensor.name, "roof");
  EXPECT_EQ(uses[0].epoch, 1);
  EXPECT_EQ(uses[0].sensor.lidar->lasers.size(), 32U);
  const Eigen::Isometry3d& mounting = uses[0].sensor.lidar->vehicle_from_scanner;
  EXPECT_DOUBLE_EQ(mounting.translation().z(), 2.1);
  EXPECT_NEAR((mounting.linear() * Eigen::Vector3d::UnitX()).z(), -0.5, 1e-12);  // nose down
  const LidarModel& five = *uses[1].sensor.lidar;
  EXPECT_FALSE(uses[1].epoch);
  ASSERT_EQ(five.lasers.size(), 3U);
  EXPECT_NEAR(five.lasers[0].elevation, -20 * EIGEN_PI / 180, 1e-12);  // rings count from the lowest
  EXPECT_EQ(five.lasers[2].ring, 2);
  EXPECT_DOUBLE_EQ(five.turn_time, 0.05);
  EXPECT_EQ(five.num_firings, 900);
  EXPECT_DOUBLE_EQ(five.pulse.farthest, 80);
  EXPECT_DOUBLE_EQ(five.pulse.range_noise, 0.02);
  const LidarModel& many = *uses[2].sensor.lidar;
  ASSERT_EQ(many.lasers.size(), 128U);
  EXPECT_NEAR(many.lasers.back().elevation, 15 * EIGEN_PI / 180, 1e-12);
}

TEST(SensorFile, KnowsTheMobileMapper) {
  const std::vector<SensorUse> uses = read(R"([{"name": "mapper", "epoch": 2}, {"name": "a", "model": "hdl64"}])");
  ASSERT_EQ(uses.size(), 2U);
  EXPECT_TRUE(uses[0].sensor.is_mapper());
  EXPECT_EQ(uses[0].epoch, 2);
  EXPECT_FALSE(uses[1].sensor.is_mapper());
}

TEST(SensorFile, SaysWhichSensorIsWrongAndWhy) {
  const std::pair<const char*, const char*> refused[] = {
      {"", "is no JSON array"},
      {"{}", "is no JSON array"},
      {"[]", "is no JSON array"},
      {"[3]", "sensor 0 is no object"},
      {R"([{"model": "vlp16"}])", "sensor 0 wants a text \"name\""},
      {R"([{"name": "../x"}])", "wants a name of letters"},
      {R"([{"name": "a", "beems": 3}])", "unknown key 'beems'"},
      {R"([{"name": "a", "model": "radar"}])", "sensor 'a' has an unknown sensor 'radar'"},
      {R"([{"name": "a", "model": "mapper"}])", "no turning scanner"},
      {R"([{"name": "a", "beams": 300}])", "\"beams\" 300, allowed are 1 to 256"},
      {R"([{"name": "a", "rate": 0}])", "\"rate\" 0, allowed are 1 to 50"},
      {R"([{"name": "a", "rate": "x"}])", "wants a number \"rate\""},
      {R"([{"name": "a", "elevations_deg": [100]}])", "elevation that is none"},
      {R"([{"name": "a", "elevations_deg": []}])", "wants 1 to 256 elevations"},
      {R"([{"name": "a", "height": 50}])", "\"height\" 50"},
      {R"([{"name": "mapper", "height": 3}])", "is the mobile mapper, which has no 'height'"},
  };
  for (const auto& [text, part] : refused) {
    try {
      read(text);
      ADD_FAILURE() << text;
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed) << text;
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_sensors("no/such/file.json"), IoError);
}

}  // namespace
}  // namespace vdbmap::simulator
