// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/verdict.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace vdbmap::registration {
namespace {

// Nothing speaks against it: every share well on the right side of its threshold, the place known to 1 cm.
BatchCandidate good_candidate() {
  BatchCandidate candidate;
  candidate.agreement = 0.8;
  candidate.evidence.overlap = 0.9;
  candidate.evidence.blocked_share = 0.1;
  candidate.covariance = Matrix6d::Identity() * 1e-4;
  return candidate;
}

template <typename Change>
std::string reason_after(const Change& change) {
  BatchCandidate candidate = good_candidate();
  change(candidate);
  return reason_not_found(std::vector{candidate}, {});
}

TEST(Verdict, AGoodCandidateAloneIsBelieved) { EXPECT_EQ(reason_not_found(std::vector{good_candidate()}, {}), ""); }

TEST(Verdict, WithoutCandidatesNoFeaturesAgree) {
  EXPECT_EQ(reason_not_found({}, {}), "no features agree with the map");
}

TEST(Verdict, PointsOutsideOfTheMapSpeakAgainstIt) {
  EXPECT_EQ(reason_after([](BatchCandidate& candidate) { candidate.evidence.overlap = 0.29; }),
            "only 29 % of the points have the map near by");
}

TEST(Verdict, SurfacesThatDoNotAgreeSpeakAgainstIt) {
  EXPECT_EQ(reason_after([](BatchCandidate& candidate) { candidate.agreement = 0.51; }),
            "only 51 % of its surfaces agree with the map's");
}

TEST(Verdict, RaysThroughWallsSpeakAgainstIt) {
  EXPECT_EQ(reason_after([](BatchCandidate& candidate) { candidate.evidence.blocked_share = 0.61; }),
            "61 % of the rays would pass through solid map");
}

TEST(Verdict, AnUncertainPlaceSpeaksAgainstIt) {
  // 0.26 m along a street, in whatever direction it runs; turns do not count.
  const auto uncertain_along = [](const Eigen::Vector3d& street) {
    return [street](BatchCandidate& candidate) {
      candidate.covariance.bottomRightCorner<3, 3>() += 0.26 * 0.26 * street * street.transpose();
    };
  };
  for (const Eigen::Vector3d& street : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0.8, 0)}) {
    EXPECT_EQ(reason_after(uncertain_along(street)), "the map does not determine its place");
    EXPECT_EQ(reason_after(uncertain_along(0.9 * street)), "");
  }
  EXPECT_EQ(reason_after([](BatchCandidate& candidate) { candidate.covariance.topLeftCorner<3, 3>() *= 1e4; }), "");
}

TEST(Verdict, ARivalThatAgreesNearlyAsWellSpeaksAgainstIt) {
  std::vector candidates{good_candidate(), good_candidate()};
  candidates[1].agreement = 0.67;  // 0.8 is less than 1.2 times that
  EXPECT_EQ(reason_not_found(candidates, {}), "another pose agrees nearly as well: 67 % of its surfaces beside 80 %");
  candidates[1].agreement = 0.66;
  EXPECT_EQ(reason_not_found(candidates, {}), "");
}

TEST(Verdict, BatchesOfFewPointsAreNotLookedFor) {
  EXPECT_EQ(reason_too_few(199, {}), "too few points: 199 of 200 needed, 1.5 m apart");
  EXPECT_EQ(reason_too_few(200, {}), "");
}

TEST(Verdict, BadOptionsAreNamed) {
  VerdictOptions options;
  options.min_agreement = 1.5;
  try {
    options.check();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "min_agreement is 1.5, expected 0 to 1");
  }
}

}  // namespace
}  // namespace vdbmap::registration
