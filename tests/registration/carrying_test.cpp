// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/carrying.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/threads.h"

namespace vdbmap::registration {
namespace {

Eigen::Isometry3d at(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

// Twenty scans a metre apart, of which the first and last five belong to batches that were found.
struct Walk {
  std::vector<PathPose> path;
  std::vector<ScanPlace> found;

  Walk() {
    for (std::size_t i = 0; i < 20; ++i) {
      path.push_back({at(static_cast<double>(i)), i > 0});
      found.push_back({});
      if (i < 5 || i >= 15) found.back() = {PlaceSource::kBatch, at(static_cast<double>(i)), 0, 0};
    }
  }

  // From this scan on odometry lies [m] farther on.
  void slip(std::size_t first, double distance) {
    for (std::size_t i = first; i < path.size(); ++i) {
      path[i].odometry_from_scan = path[i].odometry_from_scan * Eigen::Translation3d(distance, 0, 0);
    }
  }

  std::vector<ScanPlace> carry(const TrackScan& track, std::size_t max_guesses = 20) const {
    return carry_places(found, path, track, {.min_inlier_share = 0.3, .max_guesses = max_guesses});
  }
};

TrackedPose lost(std::size_t, const Eigen::Isometry3d& guess) { return {guess * at(0.5), 0.1}; }

// The map is found from a metre away.
TrackedPose tracked_from_near(std::size_t scan, const Eigen::Isometry3d& guess) {
  const auto truth = static_cast<double>(scan);
  if (std::abs(guess.translation().x() - truth) > 1) return {guess * at(0.5), 0.1};
  return {at(truth), 0.8};
}

double x_of(const ScanPlace& place) { return place.map_from_scan.translation().x(); }

TEST(Carrying, GuessesFromOneSideDoNotHinderTheOther) {
  for (const std::size_t slip : {5U, 9U, 15U}) {
    Walk walk;
    walk.slip(slip, 3);
    const std::vector<ScanPlace> places = walk.carry(tracked_from_near);
    for (std::size_t i = 0; i < 20; ++i) {
      EXPECT_EQ(places[i].source, i < 5 || i >= 15 ? PlaceSource::kBatch : PlaceSource::kTracked) << slip << " " << i;
      EXPECT_EQ(x_of(places[i]), static_cast<double>(i)) << slip << " " << i;
    }
  }
}

TEST(Carrying, OfTwoTrackedPlacesTheOneOfMoreInliersStays) {
  for (const bool is_front_better : {false, true}) {
    Walk walk;
    for (std::size_t i = 15; i < 20; ++i) walk.found[i].map_from_scan = at(static_cast<double>(i) + 0.5);
    const auto track = [&](std::size_t scan, const Eigen::Isometry3d& guess) -> TrackedPose {
      const bool is_from_front = guess.translation().x() == static_cast<double>(scan);
      return {guess, is_from_front == is_front_better ? 0.8 : 0.35};
    };
    const std::vector<ScanPlace> places = walk.carry(track);
    for (std::size_t i = 5; i < 15; ++i) {
      EXPECT_EQ(places[i].inlier_share, 0.8);
      EXPECT_EQ(x_of(places[i]), static_cast<double>(i) + (is_front_better ? 0 : 0.5));
    }
  }
}

TEST(Carrying, OfTwoGuessesTheOneFromNearerByStays) {
  Walk walk;
  walk.slip(10, 7);
  const std::vector<ScanPlace> places = walk.carry(lost);
  for (std::size_t i = 5; i < 15; ++i) {
    EXPECT_EQ(places[i].source, PlaceSource::kGuess);
    EXPECT_EQ(places[i].num_guesses, std::min(i - 4, 15 - i));
    EXPECT_EQ(x_of(places[i]), static_cast<double>(i)) << i;  // the slip lies behind the nearer end
  }
}

TEST(Carrying, EndsAfterItsLimitOfGuesses) {
  const std::vector<ScanPlace> places = Walk().carry(lost, 3);
  for (std::size_t i = 5; i < 15; ++i) EXPECT_EQ(places[i].is_known(), i < 8 || i >= 12) << i;
}

TEST(Carrying, AScanTrackedInBetweenGivesNewHope) {
  Walk walk;
  walk.found.assign(20, {});
  walk.found[0] = {PlaceSource::kBatch, at(0), 0, 0};
  const auto track = [](std::size_t scan, const Eigen::Isometry3d& guess) -> TrackedPose {
    return {guess, scan % 4 == 3 ? 0.9 : 0.0};
  };
  for (const ScanPlace& place : walk.carry(track, 4)) EXPECT_TRUE(place.is_known());
  EXPECT_FALSE(walk.carry(track, 3)[7].is_known());
}

TEST(Carrying, DoesNotCrossGaps) {
  Walk walk;
  walk.path[7].follows = walk.path[12].follows = false;
  const std::vector<ScanPlace> places = walk.carry(tracked_from_near);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(places[i].is_known(), i < 7 || i >= 12) << i;
}

TEST(Carrying, LeavesBatchesWhereTheyWereFound) {
  Walk walk;
  for (std::size_t i = 15; i < 20; ++i) walk.found[i].map_from_scan = at(static_cast<double>(i) + 0.3);
  const std::vector<ScanPlace> places = walk.carry(tracked_from_near);
  for (std::size_t i = 15; i < 20; ++i) EXPECT_EQ(x_of(places[i]), static_cast<double>(i) + 0.3);
}

TEST(Carrying, WithoutAnyBatchNothingIsKnown) {
  Walk walk;
  walk.found.assign(20, {});
  for (const ScanPlace& place : walk.carry(tracked_from_near)) EXPECT_FALSE(place.is_known());
  EXPECT_TRUE(carry_places({}, {}, lost, {}).empty());
}

TEST(Carrying, DoesNotDependOnTheNumberOfThreads) {
  Walk walk;
  walk.slip(9, 3);
  const auto one = test::on_threads(1, [&] { return walk.carry(tracked_from_near); });
  const auto four = test::on_threads(4, [&] { return walk.carry(tracked_from_near); });
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(one[i].source, four[i].source);
    EXPECT_EQ(one[i].map_from_scan.matrix(), four[i].map_from_scan.matrix());
  }
}

}  // namespace
}  // namespace vdbmap::registration
