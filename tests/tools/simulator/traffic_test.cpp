// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tools/simulator/scene_view.h"
#include "tools/simulator/traffic_plan.h"

namespace vdbmap::simulator {
namespace {

// A cube of 2 m that moves along y at 10 m/s through (0, 0, 0) at the time 5 s, turned by a quarter of a circle.
Traffic one_cube() {
  Traffic::Mover mover{7, {}, 4, {}};
  add_box({&mover.model, Eigen::Isometry3d::Identity(), 0, 7}, {-1, -1, -1}, {1, 1, 1});
  for (int i = 0; i <= 40; ++i) {
    Eigen::Isometry3d pose(Eigen::Translation3d(0, 10 * (i * Traffic::kPeriod - 1), 0));
    pose.rotate(Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitZ()));
    mover.scene_from_body.push_back(pose);
  }
  std::vector<Traffic::Mover> movers;
  movers.push_back(std::move(mover));
  return Traffic(std::move(movers));
}

TEST(Traffic, RaysMeetABodyWhereItIsAtTheirTime) {
  const Traffic traffic = one_cube();
  for (const double time : {4.53, 5.0, 5.71}) {
    const double y = 10 * (time - 5);
    const auto hit = traffic.first_hit({{-6, y + 0.3, 0.2}, Eigen::Vector3d::UnitX()}, time);
    ASSERT_TRUE(hit) << time;
    EXPECT_NEAR(hit->distance, 5, 1e-5);
    EXPECT_TRUE(hit->normal.isApprox(-Eigen::Vector3d::UnitX(), 1e-5)) << hit->normal.transpose();
    EXPECT_FALSE(traffic.first_hit({{-6, y + 1.2, 0.2}, Eigen::Vector3d::UnitX()}, time));
  }
  EXPECT_FALSE(traffic.first_hit({{-6, -10, 0}, Eigen::Vector3d::UnitX()}, 3.9));  // not there yet
}

TEST(Traffic, PointsOfWhatMovesHaveMovingClasses) {
  const Traffic traffic = one_cube();
  Mesh lasting;
  add_box({&lasting, Eigen::Isometry3d::Identity(), 0, 3}, {10, -1, -1}, {11, 1, 1});
  const RayCaster caster(lasting);
  const std::vector<Material> materials = {{SurfaceClass::kCar, Eigen::Vector3f(1, 1, 1)}};
  const SceneView view = {lasting, materials, caster, &traffic, 5};
  const Ray ray = {{-6, 0, 0}, Eigen::Vector3d::UnitX()};
  const auto moving = view.first_hit(ray);
  ASSERT_TRUE(moving);
  EXPECT_EQ(view.truth(moving->triangle), (PointTruth{252, 7}));
  const auto standing = view.at(4).first_hit(ray);
  ASSERT_TRUE(standing);
  EXPECT_EQ(view.truth(standing->triangle), (PointTruth{10, 3}));
  EXPECT_TRUE(view.is_blocked({{-6, 0, 0}, Eigen::Vector3d::UnitX(), 0, 8}));
  EXPECT_FALSE(view.at(4).is_blocked({{-6, 0, 0}, Eigen::Vector3d::UnitX(), 0, 8}));
}

class PlannedTraffic : public testing::TestWithParam<std::uint64_t> {
 protected:
  StreetLayout layout_ = make_layout({.seed = GetParam()});
  DriveOptions options_ = {.from = 30, .to = 150, .speed = 9, .start_time = 1000, .seed = GetParam()};
  World world_;
};

TEST_P(PlannedTraffic, KeepsToTheGroundToSpeedsOfTownsAndOutOfTheSurvey) {
  const Drive drive(layout_, options_);
  const Traffic traffic =
      plan_traffic(world_, layout_, options_, drive.end_time() - drive.start_time(), {}, 1, GetParam());
  EXPECT_GE(traffic.movers().size(), 8U);
  for (const Traffic::Mover& mover : traffic.movers()) {
    const std::string& kind = world_.objects()[mover.object].kind;
    EXPECT_TRUE(world_.objects()[mover.object].moves);
    double farthest_step = 0;
    for (std::size_t i = 1; i < mover.scene_from_body.size(); ++i) {
      const Eigen::Vector3d step = mover.scene_from_body[i].translation() - mover.scene_from_body[i - 1].translation();
      farthest_step = std::max(farthest_step, step.norm());
      const double time = mover.begin_time + Traffic::kPeriod * static_cast<double>(i);
      if (time < drive.start_time() || time > drive.end_time()) continue;
      const Eigen::Isometry3d survey = drive.scene_from_vehicle(time);
      // The middles of two cars that pass each other are farther apart than that.
      EXPECT_GT((mover.scene_from_body[i].translation() - survey.translation()).norm(), 1.2) << kind;
    }
    EXPECT_LT(farthest_step / Traffic::kPeriod, 14.5) << kind;  // 50 km/h and what a bend adds outside
    EXPECT_GT(farthest_step / Traffic::kPeriod, 0.5) << kind;
  }
}

TEST_P(PlannedTraffic, IsTheSameForTheSameSeed) {
  World other;
  const Traffic a = plan_traffic(world_, layout_, options_, 12, {}, 0, 5);
  const Traffic b = plan_traffic(other, layout_, options_, 12, {}, 0, 5);
  EXPECT_EQ(a.mesh().vertices, b.mesh().vertices);
  EXPECT_EQ(a.movers().size(), b.movers().size());
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlannedTraffic, testing::Values(1, 2, 3, 4));

}  // namespace
}  // namespace vdbmap::simulator
