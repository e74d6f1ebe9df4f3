// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/time_association.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

// Poses whose x is their number.
Trajectory at_times(const std::vector<double>& times) {
  Trajectory trajectory;
  trajectory.times = times;
  for (std::size_t i = 0; i < times.size(); ++i) {
    trajectory.map_from_scan.emplace_back(Eigen::Translation3d(static_cast<double>(i), 0, 0) *
                                          Eigen::Isometry3d::Identity());
  }
  return trajectory;
}

// The number of the estimate beside each true pose, -1 for none.
std::vector<int> partners(const TimeAssociation& association) {
  std::vector<int> numbers;
  for (const auto& pose : association.estimate.map_from_scan) {
    numbers.push_back(pose ? static_cast<int>(pose->translation().x()) : -1);
  }
  return numbers;
}

TEST(TimeAssociation, MissingEstimatesLeaveTheirPlaceEmpty) {
  const auto association = associate_by_time(at_times({0.1, 0.2, 0.5}), at_times({0, 0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(partners(association), (std::vector<int>{-1, 0, 1, -1, -1, 2}));
  EXPECT_EQ(association.num_unmatched, 0U);
  EXPECT_EQ(association.estimate.times.size(), 6U);
}

TEST(TimeAssociation, TimesNearEnoughArePaired) {
  const double start = 1317354879.0;  // [s] of a real recording: doubles resolve 0.2 us here
  const auto association =
      associate_by_time(at_times({start + 0.009, start + 0.111}), at_times({start, start + 0.1, start + 0.2}));
  EXPECT_EQ(partners(association), (std::vector<int>{0, -1, -1}));
  EXPECT_EQ(association.num_unmatched, 1U);
  EXPECT_EQ(partners(associate_by_time(at_times({0.5}), at_times({0}), 0.5)), (std::vector<int>{0}));
}

TEST(TimeAssociation, NoEstimateIsUsedTwice) {
  EXPECT_EQ(partners(associate_by_time(at_times({1.004}), at_times({1, 1.005, 1.01}))), (std::vector<int>{-1, 0, -1}));
  EXPECT_EQ(partners(associate_by_time(at_times({1, 1}), at_times({1, 1}))), (std::vector<int>{0, -1}));
}

TEST(TimeAssociation, OrderDoesNotMatter) {
  EXPECT_EQ(partners(associate_by_time(at_times({3, 1, 2}), at_times({2, 3, 4, 1}))), (std::vector<int>{2, 0, -1, 1}));
}

TEST(TimeAssociation, PairsAreEachOthersNearest) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> time(0, 10);
  std::vector<double> estimates(80);
  std::vector<double> truths(120);
  for (double& t : estimates) t = time(random);
  for (double& t : truths) t = time(random);
  const auto nearest = [](double t, const std::vector<double>& times) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < times.size(); ++i) {
      if (std::abs(times[i] - t) < std::abs(times[best] - t)) best = i;
    }
    return best;
  };
  const std::vector<int> found = partners(associate_by_time(at_times(estimates), at_times(truths), 0.03));
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const std::size_t partner = nearest(truths[i], estimates);
    const bool is_pair = std::abs(estimates[partner] - truths[i]) <= 0.03 && nearest(estimates[partner], truths) == i;
    EXPECT_EQ(found[i], is_pair ? static_cast<int>(partner) : -1) << i;
  }
}

std::vector<double> every(double step, int count, double start = 0) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(start + step * i);
  return times;
}

std::size_t num_missing(const TimeAssociation& association) {
  EXPECT_EQ(association.estimate.size(), association.truth.size());
  const auto& poses = association.estimate.map_from_scan;
  return static_cast<std::size_t>(std::count(poses.begin(), poses.end(), std::nullopt));
}

TEST(TimeAssociation, TruthBetweenTheScansIsNotMissing) {
  const auto association = associate_by_time(at_times(every(0.1, 50)), at_times(every(0.01, 491)));
  EXPECT_EQ(association.truth.size(), 50U);
  EXPECT_EQ(num_missing(association), 0U);
  EXPECT_EQ(association.num_unmatched, 0U);
  EXPECT_EQ(association.num_not_judged, 441U);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(association.estimate.map_from_scan[i]->translation().x(), static_cast<double>(i));
    EXPECT_EQ(association.truth.map_from_scan[i]->translation().x(), 10.0 * static_cast<double>(i));
  }
}

TEST(TimeAssociation, HolesOfTheEstimatesAreMissingAtTheirOwnRate) {
  std::vector<double> estimates = every(0.1, 50);
  estimates.erase(estimates.begin() + 30, estimates.begin() + 34);
  estimates.erase(estimates.begin() + 10);
  for (const double truth_step : {0.01, 0.005, 0.03, 0.05}) {
    const auto association =
        associate_by_time(at_times(estimates), at_times(every(truth_step, static_cast<int>(4.96 / truth_step))), 0.02);
    EXPECT_EQ(num_missing(association), 5U) << truth_step;
    EXPECT_EQ(association.truth.size(), 50U) << truth_step;
  }
}

TEST(TimeAssociation, JitterOfTheScansIsNoHole) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.015, 0.015);
  std::vector<double> estimates = every(0.1, 50);
  for (double& time : estimates) time += jitter(random);
  const auto association = associate_by_time(at_times(estimates), at_times(every(0.01, 600, -0.5)));
  EXPECT_EQ(num_missing(association), 0U);
  EXPECT_EQ(association.num_unmatched, 0U);
}

TEST(TimeAssociation, TruthThatBeginsBeforeTheScansAndEndsAfterThemIsNotMissing) {
  const auto association = associate_by_time(at_times(every(0.1, 20, 5)), at_times(every(0.01, 2000)));
  EXPECT_EQ(num_missing(association), 0U);
  EXPECT_EQ(association.truth.size(), 20U);
}

TEST(TimeAssociation, AtTheSameRateEveryTruePoseIsJudged) {
  std::vector<double> estimates;
  for (const int i : {0, 3, 4, 9, 14, 20, 21}) estimates.push_back(0.1 * i);
  const auto association = associate_by_time(at_times(estimates), at_times(every(0.1, 30)));
  EXPECT_EQ(association.truth.size(), 30U);
  EXPECT_EQ(num_missing(association), 23U);
  EXPECT_EQ(association.num_not_judged, 0U);
}

TEST(TimeAssociation, AHoleOfYearsTakesNoTime) {
  const auto association = associate_by_time(at_times({0, 0.1, 0.2, 0.3, 1e9}), at_times(every(0.01, 100)));
  EXPECT_EQ(association.truth.size(), 11U);  // of the second that the truth lasts, with its end
}

TEST(TimeAssociation, NothingIsNearNothing) {
  EXPECT_EQ(partners(associate_by_time(at_times({}), at_times({1, 2}))), (std::vector<int>{-1, -1}));
  EXPECT_EQ(associate_by_time(at_times({1, 2}), at_times({})).num_unmatched, 2U);
}

TEST(TimeAssociation, TimesAndDifferencesAreChecked) {
  Trajectory kitti = at_times({1});
  kitti.times.clear();
  EXPECT_THROW(associate_by_time(kitti, at_times({1})), std::invalid_argument);
  EXPECT_THROW(associate_by_time(at_times({1}), kitti), std::invalid_argument);
  EXPECT_THROW(associate_by_time(at_times({1}), at_times({1}), -1), std::invalid_argument);
  EXPECT_THROW(associate_by_time(at_times({1}), at_times({1}), std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace vdbmap::registration
