// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/evaluation/trajectory_plot.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "registration/evaluation/trajectory_alignment.h"
#include "tests/support/folders.h"
#include "tests/support/picture.h"

namespace vdbmap::registration {
namespace {

constexpr Rgb8 kGreen = rgb8(0x2ca02c);
constexpr Rgb8 kRed = rgb8(0xd62728);
constexpr Rgb8 kBlue = rgb8(0x4878a8);

const Eigen::AlignedBox2i kWidePlan(Eigen::Vector2i(86, 101), Eigen::Vector2i(1574, 559));

Trajectory curve(std::size_t count, const Eigen::Vector3d& shift = Eigen::Vector3d::Zero()) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 0.7 * static_cast<double>(i);
    trajectory.map_from_scan.emplace_back(
        Eigen::Translation3d(550000 + x + shift.x(), 5800000 + 0.01 * x * x + shift.y(), 60 + shift.z()) *
        Eigen::Isometry3d::Identity());
  }
  return trajectory;
}

TEST(TrajectoryPlot, ShowsTruthEstimateAndHistogramsInTheirColours) {
  const test::TemporaryFolder folder;
  write_png(folder / "plot.png", plot_trajectory(curve(60, {0.3, 0.2, 0.1}), curve(60)));
  const Image image = test::read_picture(folder / "plot.png");

  ASSERT_EQ(image.width(), 1600);
  ASSERT_EQ(image.height(), 1000);
  // Some 1300 pixels of way, of whose width of 7 the estimate and the dots leave a third.
  EXPECT_GT(test::count_pixels(image, kGreen, kWidePlan), 2000U);
  EXPECT_GT(test::count_pixels(image, kRed, kWidePlan), 60U * 25U);
  const Eigen::AlignedBox2i histograms(Eigen::Vector2i(86, 600), Eigen::Vector2i(1130, 940));
  EXPECT_GT(test::count_pixels(image, kBlue, histograms), 1000U);
  EXPECT_EQ(test::count_pixels(image, kBlue, kWidePlan), 0U);
}

// The mean of the pixels of a colour.
Eigen::Vector2d middle_of(const Image& image, Rgb8 color, const Eigen::AlignedBox2i& box) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0;
  for (int y = box.min().y(); y <= box.max().y(); ++y) {
    for (int x = box.min().x(); x <= box.max().x(); ++x) {
      if (image.at(x, y) != color) continue;
      sum += Eigen::Vector2d(x + 0.5, y + 0.5);
      ++count;
    }
  }
  return sum / count;
}

TEST(TrajectoryPlot, AnEstimateToTheLeftOfTheWayIsDrawnAboveIt) {
  // Along x, left is +y: up in the picture, as many pixels a metre as along the way.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i <= 40; ++i) {
    truth.map_from_scan.emplace_back(Eigen::Translation3d(i, 0, 0) * Eigen::Isometry3d::Identity());
    estimate.map_from_scan.emplace_back(Eigen::Translation3d(i, 4, 0) * Eigen::Isometry3d::Identity());
  }
  const Image image = plot_trajectory(estimate, truth);
  const double pixels_per_metre = 1490 / (40 * 1.12);  // a margin of 6 % on either side
  const Eigen::Vector2d green = middle_of(image, kGreen, kWidePlan);
  const Eigen::Vector2d red = middle_of(image, kRed, kWidePlan);

  EXPECT_NEAR(green.y() - red.y(), 4 * pixels_per_metre, 2);
  EXPECT_NEAR(green.x(), red.x(), 5);  // the word "start" lies over a little of the green
}

TEST(TrajectoryPlot, MissingScansAreMarked) {
  const Trajectory truth = curve(60);
  Trajectory estimate = truth;
  const Rgb8 black = rgb8(0x202020);
  const std::size_t before = test::count_pixels(plot_trajectory(estimate, truth), black, kWidePlan);
  for (const std::size_t i : {20U, 21U, 40U}) estimate.map_from_scan[i].reset();
  const std::size_t marked = test::count_pixels(plot_trajectory(estimate, truth), black, kWidePlan);
  EXPECT_GT(marked, before + 3 * 30);  // a ring of radius 6 and width 2 covers 75 pixels, half of them wholly
}

TEST(TrajectoryPlot, EveryNumberOfPosesGivesAPicture) {
  const Trajectory truth = curve(5);
  Trajectory lost = truth;
  for (auto& pose : lost.map_from_scan) pose.reset();
  EXPECT_EQ(test::count_pixels(plot_trajectory(lost, truth), kBlue), 0U);
  EXPECT_GT(test::count_pixels(plot_trajectory(curve(1), curve(1)), kRed, kWidePlan), 20U);
  EXPECT_GT(test::count_pixels(plot_trajectory(curve(5, {1e6, -1e6, 1e5}), truth), kGreen), 20U);
}

TEST(TrajectoryPlot, ALongWayUpIsShownBesideTheHistograms) {
  const Eigen::Isometry3d quarter_turn(Eigen::AngleAxisd(1.5707963, Eigen::Vector3d::UnitZ()));
  const Trajectory truth = moved(curve(60), quarter_turn);
  const Image image = plot_trajectory(truth, truth);
  const Eigen::AlignedBox2i plan(Eigen::Vector2i(86, 101), Eigen::Vector2i(1039, 939));
  EXPECT_GT(test::count_pixels(image, kGreen, plan), 1000U);  // some 800 pixels of way, mostly under the estimate
}

TEST(TrajectoryPlot, SameTrajectoriesGiveTheSameBytes) {
  EXPECT_EQ(png_of(plot_trajectory(curve(20, {0.1, 0, 0}), curve(20))),
            png_of(plot_trajectory(curve(20, {0.1, 0, 0}), curve(20))));
}

TEST(TrajectoryPlot, WrongArgumentsAreRefused) {
  EXPECT_THROW(plot_trajectory(curve(3), curve(4)), std::invalid_argument);
  EXPECT_THROW(plot_trajectory({}, {}), std::invalid_argument);
  for (const int size : {0, 799, 100'000}) {
    TrajectoryPlotOptions options;
    options.height = size;
    EXPECT_THROW(plot_trajectory(curve(3), curve(3), options), std::invalid_argument);
  }
}

}  // namespace
}  // namespace vdbmap::registration
