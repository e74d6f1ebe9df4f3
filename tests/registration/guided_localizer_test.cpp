// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/guided_localizer.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/moving_scanner.h"
#include "tests/support/pose_distance.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/store/city_of_map.h"

namespace vdbmap::registration {
namespace {

constexpr double kPeriod = 0.1;  // [s]
constexpr int kTurns = 8;

const VoxelMap& guided_map() {
  static const VoxelMap map = build_map(test::survey_of_village());
  return map;
}

// 8 m/s along the street, swerving a little: the first and the last scan have a neighbour on one side only.
Eigen::Isometry3d sensor_at(double seconds) {
  return Eigen::Translation3d(-14 + 8 * seconds, 0.5 + 0.1 * std::sin(2 * seconds), 1.8) *
         Eigen::AngleAxisd(0.05 * std::sin(2 * seconds), Eigen::Vector3d::UnitZ());
}

Eigen::Isometry3d truth(int turn) { return sensor_at(kPeriod * turn); }

const std::vector<PointCloud>& turns() {
  static const std::vector<PointCloud> scans = [] {
    std::vector<PointCloud> made;
    for (int i = 0; i < kTurns; ++i) {
      test::Scanner scanner;
      scanner.num_azimuths = 600;
      scanner.range_noise = 0.01;
      scanner.seed = static_cast<unsigned>(i) + 1;
      made.push_back(test::scan_while_moving(test::village(), sensor_at, kPeriod * i, kPeriod, scanner));
    }
    return made;
  }();
  return scans;
}

const PointCloud& turn(int number) { return turns()[static_cast<std::size_t>(number)]; }

// Another error for each scan: 0.6 m and 2 degrees.
Eigen::Isometry3d guess(int number) {
  const double angle = 2.4 * number;
  return truth(number) * Eigen::Translation3d(0.6 * std::cos(angle), 0.6 * std::sin(angle), 0) *
         Eigen::AngleAxisd(0.035 * std::cos(angle), Eigen::Vector3d::UnitZ());
}

// Of first points: 0.4 m off without deskewing.
void expect_first_point(const LocalizedScan& scan, int number) {
  EXPECT_TRUE(scan.found()) << number << ": " << scan.reason;
  EXPECT_EQ(scan.time_problem, "") << number;
  const auto error = test::distance_between(scan.fine.map_from_scan, truth(number));
  EXPECT_LT(error.translation, 0.03) << number;
  EXPECT_LT(error.rotation_deg, 0.2) << number;
}

TEST(GuidedLocalizer, FindsFirstPointsFromGuessesOfEachScan) {
  GuidedLocalizer localizer(guided_map());
  for (int i = 0; i < kTurns; ++i) localizer.add(turn(i), guess(i));
  const std::vector<LocalizedScan> found = localizer.finish();
  ASSERT_EQ(found.size(), turns().size());
  for (int i = 0; i < kTurns; ++i) expect_first_point(found[static_cast<std::size_t>(i)], i);
}

// A file and a city of the same map.
TEST(GuidedLocalizer, FindsInACityWhatItFindsInOneMap) {
  const test::TemporaryFolder folder;
  save_city(folder / "city", guided_map());
  const MapWindows city(
      open_city(folder / "city"), [](const CityTile&) { return true; }, 0);
  const auto find = [](const MapWindows& map) {
    GuidedLocalizer localizer(map);
    for (int i = 0; i < kTurns; ++i) localizer.add(turn(i), guess(i));
    return localizer.finish();
  };
  const std::vector<LocalizedScan> in_map = find(guided_map());
  const std::vector<LocalizedScan> in_city = find(city);
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    EXPECT_TRUE(in_city[i].found()) << in_city[i].reason;
    EXPECT_EQ(in_city[i].fine.map_from_scan.matrix(), in_map[i].fine.map_from_scan.matrix());
    EXPECT_EQ(in_city[i].fine.covariance, in_map[i].fine.covariance);
  }
}

TEST(GuidedLocalizer, FindsFirstPointsFromAGuessOfTheFirstScan) {
  GuidedLocalizer localizer(guided_map());
  localizer.follow_from(guess(0));
  for (int i = 0; i < kTurns; ++i) localizer.add(turn(i));
  const std::vector<LocalizedScan> found = localizer.finish();
  for (int i = 0; i < kTurns; ++i) expect_first_point(found[static_cast<std::size_t>(i)], i);
}

TEST(GuidedLocalizer, TimesMayBeginAnewAndScansBeLeftOut) {
  for (const bool is_followed : {true, false}) {
    GuidedLocalizer localizer(guided_map());
    if (is_followed) localizer.follow_from(guess(0));
    const std::vector<int> numbers = {0, 1, 3, 5, 7};  // what is followed must know the motion first
    for (const int i : numbers) {
      PointCloud scan = turn(i);
      for (double& time : scan.times) time -= kPeriod * i;
      is_followed ? localizer.add(scan) : localizer.add(scan, guess(i));
      if (i > 0) localizer.pass_over(1);
    }
    const std::vector<LocalizedScan> found = localizer.finish();
    for (std::size_t i = 0; i < numbers.size(); ++i) expect_first_point(found[i], numbers[i]);
  }
}

TEST(GuidedLocalizer, ScansOfNoUseKeepTheirPlaceAndTheOthersTheirs) {
  PointCloud far;
  far.positions = {{500, 0, 0}, {0, 500, 0}};
  for (const bool is_followed : {true, false}) {
    GuidedLocalizer localizer(guided_map());
    if (is_followed) localizer.follow_from(guess(0));
    const auto add = [&](const PointCloud& scan, int i) {
      is_followed ? localizer.add(scan) : localizer.add(scan, guess(i));
    };
    add(turn(0), 0);
    add(turn(1), 1);
    localizer.skip("cannot be read");
    add(turn(3), 3);
    add(far, 4);
    add(turn(5), 5);
    add(PointCloud(), 6);
    add(turn(7), 7);
    const std::vector<LocalizedScan> found = localizer.finish();
    ASSERT_EQ(found.size(), 8U);
    EXPECT_EQ(found[2].reason, "cannot be read");
    EXPECT_EQ(found[4].reason, "no point lies within the range limits");
    EXPECT_EQ(found[6].reason, "it holds no points");
    for (const int i : {0, 1, 3, 5, 7}) expect_first_point(found[static_cast<std::size_t>(i)], i);
  }
}

TEST(GuidedLocalizer, AScanWithoutAGuessIsNotLookedFor) {
  GuidedLocalizer localizer(guided_map());
  localizer.add(turn(0), guess(0));
  localizer.add(turn(1), std::nullopt);
  localizer.add(turn(2), guess(2));
  const std::vector<LocalizedScan> found = localizer.finish();
  EXPECT_EQ(found[1].reason, "no guess");
  for (const int i : {0, 2}) expect_first_point(found[static_cast<std::size_t>(i)], i);
}

TEST(GuidedLocalizer, ScansWithoutTimesAreAlignedAsTheyAre) {
  PointCloud still = test::scan_scene(test::village(), truth(3));
  GuidedLocalizer localizer(guided_map());
  for (int i = 0; i < 2; ++i) localizer.add(still, guess(3));
  const std::vector<LocalizedScan> found = localizer.finish();
  const LocalizedScan alone = localize_scan(still, guided_map(), guess(3));
  for (const LocalizedScan& scan : found) {
    EXPECT_EQ(scan.fine.map_from_scan.matrix(), alone.fine.map_from_scan.matrix());
  }
}

// The middle of its times is all that a single scan tells.
TEST(GuidedLocalizer, ASingleScanIsTakenAsIfTheSensorStoodStill) {
  GuidedLocalizer localizer(guided_map());
  localizer.add(turn(3), guess(3));
  const LocalizedScan found = localizer.finish().front();
  EXPECT_TRUE(found.found()) << found.reason;
  EXPECT_LT(test::distance_between(found.fine.map_from_scan, sensor_at(kPeriod * 3.5)).translation, 0.1);
}

TEST(GuidedLocalizer, IsAsNewAfterFinish) {
  GuidedLocalizer localizer(guided_map());
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 3; ++i) localizer.add(turn(i), guess(i));
    const std::vector<LocalizedScan> found = localizer.finish();
    ASSERT_EQ(found.size(), 3U);
    expect_first_point(found[1], 1);
  }
}

TEST(GuidedLocalizer, DoesNotDependOnTheNumberOfThreads) {
  const auto poses = [] {
    GuidedLocalizer localizer(guided_map());
    for (int i = 0; i < 4; ++i) localizer.add(turn(i), guess(i));
    std::vector<double> numbers;
    for (const LocalizedScan& scan : localizer.finish()) {
      const auto matrix = scan.fine.map_from_scan.matrix().reshaped();
      numbers.insert(numbers.end(), matrix.begin(), matrix.end());
    }
    return numbers;
  };
  EXPECT_EQ(test::on_threads(1, poses), test::on_threads(4, poses));
}

}  // namespace
}  // namespace vdbmap::registration
