// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/sequence.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/moving_scanner.h"
#include "tests/support/pose_distance.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/threads.h"
#include "vdbmap/core/map_builder.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/store/city_of_map.h"

namespace vdbmap::registration {
namespace {

const VoxelMap& street_map() {
  static const VoxelMap map = build_map(test::survey_of_village());
  return map;
}

// A drive down the street, a metre a scan, every scan with noise of its own; the sensor is turned so that no axis is
// the map's.
struct Drive {
  std::vector<Eigen::Isometry3d> map_from_scan;
  std::vector<PointCloud> scans;

  explicit Drive(int num_scans, double first_x = -14, double step = 1) {
    for (int i = 0; i < num_scans; ++i) {
      Eigen::Isometry3d pose(Eigen::Translation3d(first_x + step * i, 0.5 + 0.02 * i, 1.8));
      pose.rotate(Eigen::AngleAxisd(2.3 + 0.01 * i, Eigen::Vector3d::UnitZ()));
      map_from_scan.push_back(pose);
      test::Scanner scanner;
      scanner.num_azimuths = 600;
      scanner.range_noise = 0.01;
      scanner.seed = static_cast<unsigned>(i) + 1;
      scans.push_back(test::scan_scene(test::village(), pose, scanner));
    }
  }
};

// Of a scan that is found: a few centimetres, from 1 cm of noise on points a metre apart.
void expect_found(const SequenceScan& scan, const Eigen::Isometry3d& truth) {
  EXPECT_TRUE(scan.found()) << scan.reason;
  const auto error = test::distance_between(scan.map_from_scan, truth);
  EXPECT_LT(error.translation, 0.04);
  EXPECT_LT(error.rotation_deg, 0.3);
}

SequenceResult localize(const std::vector<PointCloud>& scans, const MapWindows& map = street_map(),
                        const LocalizerOptions& options = {}) {
  SequenceLocalizer localizer(map, options);
  for (const PointCloud& scan : scans) localizer.add(scan);
  return localizer.finish();
}

TEST(Sequence, IsFoundWithNoFirstGuess) {
  const Drive drive(8);
  const SequenceResult result = localize(drive.scans);
  ASSERT_EQ(result.scans.size(), 8u);
  ASSERT_EQ(result.batches.size(), 1u);
  EXPECT_TRUE(result.batches[0].search.found()) << result.batches[0].search.reason;
  for (std::size_t i = 0; i < 8; ++i) expect_found(result.scans[i], drive.map_from_scan[i]);
}

// A file and a city of the same map: the tiles of the village are loaded as they are looked at.
TEST(Sequence, IsFoundInACityAsInOneMap) {
  const test::TemporaryFolder folder;
  save_city(folder / "city", street_map());
  ASSERT_GT(tiles_of(street_map()).size(), 1u);
  const MapWindows city(
      open_city(folder / "city"), [](const CityTile&) { return true; }, 0);
  const Drive drive(6);
  const SequenceResult in_map = localize(drive.scans);
  const SequenceResult in_city = localize(drive.scans, city);
  for (std::size_t i = 0; i < drive.scans.size(); ++i) {
    expect_found(in_city.scans[i], drive.map_from_scan[i]);
    EXPECT_EQ(in_city.scans[i].map_from_scan.matrix(), in_map.scans[i].map_from_scan.matrix());
    EXPECT_EQ(in_city.scans[i].covariance, in_map.scans[i].covariance);
  }
}

// At 8 m/s over a road that lifts it by 5 cm, so fast that the motion since the scan before says little of that within
// a scan: taken for it, the first points would lie 3 cm off.
Eigen::Isometry3d jolted_sensor_at(double seconds) {
  const double phase = 2 * std::numbers::pi * 1.5 * seconds;
  return Eigen::Translation3d(-14 + 8 * seconds, 0.5, 1.8 + 0.05 * std::sin(phase)) *
         Eigen::AngleAxisd(0.01 * std::cos(phase), Eigen::Vector3d::UnitY());
}

constexpr int kJoltedScans = 10;

// Whose time stamps are common to all scans, or begin anew with each.
std::vector<PointCloud> jolted_scans(bool have_common_epoch) {
  constexpr double kTimeOfScan = 0.1;  // [s]
  std::vector<PointCloud> scans;
  for (int i = 0; i < kJoltedScans; ++i) {
    test::Scanner scanner;
    scanner.num_azimuths = 600;
    scanner.range_noise = 0.01;
    scanner.seed = static_cast<unsigned>(i) + 1;
    scans.push_back(test::scan_while_moving(test::village(), jolted_sensor_at, kTimeOfScan * i, kTimeOfScan, scanner));
    if (have_common_epoch) continue;
    for (double& time : scans.back().times) time -= kTimeOfScan * i;
  }
  return scans;
}

// Root mean square [m] of the scans with a neighbour on both sides.
double jolted_error(const SequenceResult& result) {
  double sum_of_squares = 0;
  for (std::size_t i = 1; i + 1 < kJoltedScans; ++i) {
    const SequenceScan& scan = result.scans[i];
    EXPECT_TRUE(scan.found()) << i << ": " << scan.reason;
    const Eigen::Isometry3d truth = jolted_sensor_at(0.1 * static_cast<double>(i));
    sum_of_squares += (scan.map_from_scan.translation() - truth.translation()).squaredNorm();
  }
  return std::sqrt(sum_of_squares / (kJoltedScans - 2));
}

TEST(Sequence, FirstPointsOfAJoltedScannerAreFoundBetweenItsScans) {
  EXPECT_LT(jolted_error(localize(jolted_scans(true))), 0.01);
}

TEST(Sequence, TimeStampsMayBeginAnewWithEachScan) { EXPECT_LT(jolted_error(localize(jolted_scans(false))), 0.01); }

TEST(Sequence, GivenOdometryTellsTheFirstPointsToo) {
  // The path is all that odometry knows: it begins where the sensor did.
  const std::vector<PointCloud> scans = jolted_scans(true);
  SequenceLocalizer localizer(street_map());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    localizer.add(scans[i], jolted_sensor_at(0).inverse() * jolted_sensor_at(0.1 * static_cast<double>(i)));
  }
  EXPECT_LT(jolted_error(localizer.finish()), 0.01);
}

Eigen::Isometry3d even_sensor_at(double seconds) {
  return Eigen::Isometry3d(Eigen::Translation3d(-14 + 5 * seconds, 0.5, 1.8));
}

// Of the first points at 5 m/s: 0.25 m off where the clock counts a turn too few or too many.
void expect_even_motion(const SequenceResult& result, const std::vector<int>& turns) {
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (turns[i] < 0) continue;
    EXPECT_TRUE(result.scans[i].found()) << i << ": " << result.scans[i].reason;
    EXPECT_LT((result.scans[i].map_from_scan.translation() - even_sensor_at(0.1 * turns[i]).translation()).norm(), 0.03)
        << i;
  }
}

// A turn whose time stamps begin anew.
PointCloud even_scan(int turn) {
  test::Scanner scanner;
  scanner.num_azimuths = 600;
  scanner.range_noise = 0.01;
  scanner.seed = static_cast<unsigned>(turn) + 1;
  PointCloud scan = test::scan_while_moving(test::village(), even_sensor_at, 0.1 * turn, 0.1, scanner);
  for (double& time : scan.times) time -= 0.1 * turn;
  return scan;
}

TEST(Sequence, TimesThatBeginAnewDeskewRightWhereScansAreLeftOut) {
  const std::vector<PointCloud> scans = jolted_scans(false);
  for (const bool has_poses : {true, false}) {
    SequenceLocalizer localizer(street_map());
    for (int turn = 0; turn < kJoltedScans; ++turn) {
      const PointCloud& scan = scans[static_cast<std::size_t>(turn)];
      if (turn == 4) {
        localizer.skip("cannot be read");
      } else if (turn == 7) {
        localizer.pass_over(1);
      } else if (has_poses) {
        localizer.add(scan, jolted_sensor_at(0).inverse() * jolted_sensor_at(0.1 * turn));
      } else {
        localizer.add(scan);
      }
    }
    const SequenceResult result = localizer.finish();
    const std::vector<int> turns = {0, 1, 2, 3, -1, 5, 6, 8, 9};
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (turns[i] < 0) continue;
      EXPECT_TRUE(result.scans[i].found()) << i << ": " << result.scans[i].reason;
      const Eigen::Isometry3d truth = jolted_sensor_at(0.1 * turns[i]);
      // A jolt of 5 cm that a gap hides; 0.4 m off where the clock counts a turn too few.
      EXPECT_LT((result.scans[i].map_from_scan.translation() - truth.translation()).norm(), 0.08) << i;
    }
  }
}

TEST(Sequence, TimesThatBeginAnewDeskewRightWhereAPoseIsMissing) {
  SequenceLocalizer localizer(street_map());
  for (const int turn : {0, 1, 2, 3, 4}) {
    localizer.add(even_scan(turn), turn == 2 ? std::nullopt : std::optional(even_sensor_at(0.1 * turn)));
  }
  expect_even_motion(localizer.finish(), {0, 1, -1, 3, 4});
}

TEST(Sequence, IsFoundInAMapAtUtmCoordinates) {
  const Eigen::Vector3d utm(552'320, 5'802'560, 64);
  BuildOptions options;
  const VoxelMap map =
      build_map(test::moved(test::survey_of_village(), Eigen::Isometry3d(Eigen::Translation3d(utm))), options);
  const Drive drive(4);
  const SequenceResult result = localize(drive.scans, map);
  for (std::size_t i = 0; i < 4; ++i) expect_found(result.scans[i], Eigen::Translation3d(utm) * drive.map_from_scan[i]);
}

TEST(Sequence, FollowsGivenOdometry) {
  const Drive drive(6);
  SequenceLocalizer localizer(street_map());
  for (std::size_t i = 0; i < 6; ++i) {
    const bool is_missing = i == 2;
    localizer.add(drive.scans[i],
                  is_missing ? std::nullopt : std::optional(drive.map_from_scan[0].inverse() * drive.map_from_scan[i]));
  }
  const SequenceResult result = localizer.finish();
  EXPECT_FALSE(result.scans[2].found());
  EXPECT_NE(result.scans[2].reason.find("odometry has no pose"), std::string::npos);
  for (const std::size_t i : {0u, 1u, 3u, 4u, 5u}) expect_found(result.scans[i], drive.map_from_scan[i]);
}

TEST(Sequence, GoesOnAfterAGap) {
  const Drive first(4, -20);
  const Drive second(4, 14);  // 30 m on
  std::vector<PointCloud> scans = first.scans;
  scans.insert(scans.end(), second.scans.begin(), second.scans.end());
  const SequenceResult result = localize(scans);
  for (std::size_t i = 0; i < 4; ++i) {
    expect_found(result.scans[i], first.map_from_scan[i]);
    expect_found(result.scans[4 + i], second.map_from_scan[i]);
  }
}

TEST(Sequence, LeavesOutScansWithoutUse) {
  const Drive drive(4);
  std::vector<PointCloud> scans = drive.scans;
  scans.insert(scans.begin() + 2, PointCloud());
  PointCloud far;
  far.positions = {{500, 0, 0}, {0, 500, 0}, {0, 0, 500}};
  scans.push_back(far);
  SequenceLocalizer localizer(street_map());
  for (const PointCloud& scan : scans) localizer.add(scan);
  localizer.skip("cannot be read");
  const SequenceResult result = localizer.finish();
  ASSERT_EQ(result.scans.size(), 7u);
  for (const std::size_t i : {2u, 5u, 6u}) {
    EXPECT_FALSE(result.scans[i].found());
    EXPECT_FALSE(result.scans[i].reason.empty());
  }
  EXPECT_EQ(result.scans[6].reason, "cannot be read");
  expect_found(result.scans[1], drive.map_from_scan[1]);
  expect_found(result.scans[4], drive.map_from_scan[3]);
}

TEST(Sequence, AScanThatRepeatsLiesWhereItLay) {
  const Drive drive(3);
  const SequenceResult result = localize({drive.scans[0], drive.scans[1], drive.scans[1], drive.scans[2]});
  expect_found(result.scans[1], drive.map_from_scan[1]);
  expect_found(result.scans[2], drive.map_from_scan[1]);
  expect_found(result.scans[3], drive.map_from_scan[2]);
}

TEST(Sequence, IsNotFoundInAMapOfAnotherPlace) {
  const VoxelMap room = build_map(test::sample_scene(test::room(), 300, 1));
  const SequenceResult result = localize(Drive(4).scans, room);
  for (const SequenceScan& scan : result.scans) EXPECT_FALSE(scan.found());
  EXPECT_FALSE(result.batches[0].search.reason.empty());
}

// Another part of the same street, with houses, cars and posts of the same kinds.
TEST(Sequence, IsNotFoundInAMapThatItDoesNotOverlap) {
  for (const double side : {-1.0, 1.0}) {
    PointCloud survey = test::survey_of_village();
    std::erase_if(survey.positions, [&](const Eigen::Vector3d& point) { return side * point.x() < 2; });
    Drive drive(8, -side * 20 - 4);
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      std::erase_if(drive.scans[i].positions,
                    [&](const Eigen::Vector3d& point) { return side * (drive.map_from_scan[i] * point).x() > -2; });
    }
    const SequenceResult result = localize(drive.scans, build_map(survey));
    for (const SequenceScan& scan : result.scans) EXPECT_FALSE(scan.found());
    EXPECT_FALSE(result.batches[0].search.reason.empty());
  }
}

TEST(Sequence, IsNotFoundWhereNothingTellsOnePlaceFromAnother) {
  const VoxelMap corridor = build_map(test::sample_scene(test::corridor(), 100, 1));
  test::Scanner scanner;
  scanner.num_azimuths = 600;
  const PointCloud scan =
      test::scan_scene(test::corridor(), Eigen::Isometry3d(Eigen::Translation3d(7, 0, 1.5)), scanner);
  const SequenceResult result = localize({scan, scan, scan}, corridor);
  for (const SequenceScan& located : result.scans) EXPECT_FALSE(located.found());
}

TEST(Sequence, OfNothingIsNothing) {
  const SequenceResult result = localize({});
  EXPECT_TRUE(result.scans.empty());
  EXPECT_TRUE(result.batches.empty());
}

TEST(Sequence, IsAsNewAfterFinish) {
  const Drive drive(3);
  SequenceLocalizer localizer(street_map());
  for (int round = 0; round < 2; ++round) {
    for (const PointCloud& scan : drive.scans) localizer.add(scan);
    const SequenceResult result = localizer.finish();
    ASSERT_EQ(result.scans.size(), 3u);
    expect_found(result.scans[2], drive.map_from_scan[2]);
  }
}

TEST(Sequence, DoesNotDependOnTheNumberOfThreads) {
  const Drive drive(4);
  const auto one = test::on_threads(1, [&] { return localize(drive.scans); });
  const auto four = test::on_threads(4, [&] { return localize(drive.scans); });
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(one.scans[i].map_from_scan.matrix(), four.scans[i].map_from_scan.matrix());
    EXPECT_EQ(one.scans[i].covariance, four.scans[i].covariance);
  }
}

TEST(Sequence, NeedsACoarseLevel) {
  BuildOptions options;
  options.voxel_sizes = {0.1};
  const VoxelMap fine = build_map(test::sample_scene(test::room(), 50, 1), options);
  EXPECT_THROW(SequenceLocalizer{fine}, std::invalid_argument);
}

TEST(Localizer, RefusesOptionsOutOfRange) {
  LocalizerOptions options;
  options.batch_size = 0;
  EXPECT_THROW(Localizer(street_map(), options), std::invalid_argument);
  options = {};
  options.verdict.min_margin = 0.5;
  EXPECT_THROW(Localizer(street_map(), options), std::invalid_argument);
  options = {};
  options.verdict.max_deviation = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Localizer(street_map(), options), std::invalid_argument);
}

class SlipOfGivenOdometry : public testing::TestWithParam<double> {};

// Between two scans of a batch and between two batches. What is found lies where it lies without the slip. 5 m are more
// than a scan can be tracked over.
TEST_P(SlipOfGivenOdometry, MovesNoScanThatIsFound) {
  static const Drive drive(12);
  LocalizerOptions options;
  options.batch_size = 4;
  const auto localize_with_slip = [&](std::size_t scan, double slip) {
    Localizer localizer(street_map(), options);
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      const Eigen::Isometry3d odometry = drive.map_from_scan[0].inverse() * drive.map_from_scan[i];
      const double moved = i >= scan ? slip : 0;
      localizer.add({drive.scans[i].positions, Eigen::Translation3d(0.8 * moved, 0.6 * moved, 0) * odometry, true});
    }
    return localizer.finish();
  };
  static const SequenceResult before = localize_with_slip(0, 0);
  for (const std::size_t scan : {4U, 6U}) {
    const SequenceResult after = localize_with_slip(scan, GetParam());
    for (std::size_t i = 0; i < drive.scans.size(); ++i) {
      EXPECT_TRUE(after.scans[i].found() || GetParam() > 2) << scan << " " << i << ": " << after.scans[i].reason;
      if (!after.scans[i].found()) continue;
      const auto shift = test::distance_between(after.scans[i].map_from_scan, before.scans[i].map_from_scan);
      EXPECT_LT(shift.translation, 0.02) << scan << " " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Metres, SlipOfGivenOdometry, testing::Values(0.5, 5.0));

// Two batches that odometry says lie 3 m apart, but one of them is a scan of another part of the street.
TEST(Localizer, BelievesNoBatchThatOdometryContradicts) {
  const Drive here(3, -20), there(3, 14);
  LocalizerOptions options;
  options.batch_size = 3;
  Localizer localizer(street_map(), options);
  for (std::size_t i = 0; i < 6; ++i) {
    const PointCloud& scan = i < 3 ? here.scans[i] : there.scans[i - 3];
    const Eigen::Isometry3d odometry = Eigen::Isometry3d(Eigen::Translation3d(-0.7 * static_cast<double>(i), 0, 0));
    localizer.add({scan.positions, odometry, true});
  }
  const SequenceResult result = localizer.finish();
  for (const SequenceScan& scan : result.scans) EXPECT_FALSE(scan.found());
}

}  // namespace
}  // namespace vdbmap::registration
