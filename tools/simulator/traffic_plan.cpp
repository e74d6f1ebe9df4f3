// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/traffic_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/simulator/things/people.h"
#include "tools/simulator/vehicle_model.h"

namespace vdbmap::simulator {
namespace {

using std::numbers::pi;

constexpr double kInSight = 12;        // [s] before and after it meets the survey
constexpr double kSafeDistance = 2.4;  // [m] of a vehicle's middle from obstacles
constexpr double kSurveyLane = -0.8;   // [m] as Drive has it
constexpr double kFarFromSurvey = 14;  // [m] that somebody who crosses keeps from it

// A way along the route or across it.
struct Way {
  double meets_at;             // [s] when it is beside the survey, or in its lane
  double from;                 // [m] along the route at that time
  double speed;                // [m/s] along the route, negative against it
  double aside;                // [m] at that time
  double aside_speed = 0;      // [m/s] to the left
  double duration = kInSight;  // [s] before and after
};

// Walkers and riders: what they look like, how fast they are.
struct WalkerKind {
  const char* name;
  double share;
  double slowest, fastest;  // [m/s]
  void (*draw)(const Site& site);
};

constexpr auto kWalkers = std::to_array<WalkerKind>({
    {"person", 0.6, 1.0, 1.8, draw_person},
    {"group", 0.14, 0.9, 1.4, draw_group},
    {"dog", 0.1, 0.9, 1.5, draw_dog},
    {"pram", 0.08, 0.9, 1.4, draw_pram},
    {"wheelchair", 0.08, 0.8, 1.5, draw_wheelchair},
});

class Planner {
 public:
  Planner(World& world, const Route& route, const DriveOptions& drive, double duration,
          const std::vector<Eigen::Vector2d>& obstacles, int epoch, std::uint64_t seed)
      : world_(world),
        route_(route),
        drive_(drive),
        duration_(duration),
        obstacles_(obstacles),
        epoch_(epoch),
        random_(seed) {}

  std::vector<Traffic::Mover> plan() {
    if (random_.chance(0.6)) add_companion(random_.uniform(14, 30));
    if (random_.chance(0.5)) add_companion(-random_.uniform(10, 20));
    for (double t = random_.uniform(0, 4); t < duration_; t += random_.uniform(2.5, 9)) add_oncoming(t);
    for (double t = random_.uniform(0, 6); t < duration_; t += random_.uniform(4, 14)) add_cyclist(t);
    for (double t = random_.uniform(0, 1); t < duration_; t += random_.uniform(0.6, 3)) add_walker(t);
    for (double t = random_.uniform(4, 9); t < duration_; t += random_.uniform(5, 14)) add_crossing(t);
    return std::move(movers_);
  }

 private:
  double survey_at(double time) const { return drive_.from + drive_.speed * time; }

  // Poses along a way, cut to what the route and the drive's time have of it.
  std::vector<Eigen::Isometry3d> poses_of(const Way& way, double& begin_time) const {
    std::vector<Eigen::Isometry3d> poses;
    const double course = std::atan2(way.aside_speed, way.speed);
    for (double t = way.meets_at - way.duration; t <= way.meets_at + way.duration; t += Traffic::kPeriod) {
      const double along = way.from + way.speed * (t - way.meets_at);
      if (along < route_.begin() + 1 || along > route_.end() - 1) continue;
      if (poses.empty()) begin_time = drive_.start_time + t;
      poses.push_back(route_.place(along, way.aside + way.aside_speed * (t - way.meets_at), course));
    }
    return poses;
  }

  bool runs_into_something(const std::vector<Eigen::Isometry3d>& poses) const {
    return std::ranges::any_of(poses, [&](const Eigen::Isometry3d& pose) {
      return std::ranges::any_of(obstacles_, [&](const Eigen::Vector2d& obstacle) {
        return (pose.translation().head<2>() - obstacle).norm() < kSafeDistance + 2;
      });
    });
  }

  template <typename Draw>
  void add(const char* name, const Way& way, bool is_vehicle, const Draw& draw) {
    double begin_time = 0;
    std::vector<Eigen::Isometry3d> poses = poses_of(way, begin_time);
    if (poses.size() < 2 || (is_vehicle && runs_into_something(poses))) return;
    SceneObject object{name, poses.front().translation(), epoch_, true};
    Traffic::Mover mover{world_.add_object(std::move(object)), {}, begin_time, std::move(poses)};
    draw(Brush{&mover.model, Eigen::Isometry3d::Identity(), 0, mover.object});
    movers_.push_back(std::move(mover));
  }

  void add_vehicle_on(const Way& way) {
    const double choice = random_.uniform(0, 1);
    VehicleShape shape = make_vehicle_shape(6, random_);
    if (choice < 0.10) shape = make_large_shape(VehicleBody::kBoxVan, 7, random_);
    if (choice > 0.94) shape = make_large_shape(VehicleBody::kTruck, 10, random_);
    if (choice > 0.98) shape = make_large_shape(VehicleBody::kBus, 13, random_);
    const std::string name = name_of(shape.body);
    add(name.c_str(), way, true, [&](const Brush& brush) {
      add_any_vehicle(brush.with(world_.add_paint(class_of(shape.body), random_)), shape, world_);
    });
  }

  // Drives as the survey does, ahead or behind, for the whole time.
  void add_companion(double ahead) {
    const double middle = duration_ / 2;
    add_vehicle_on({middle, survey_at(middle) + ahead, drive_.speed, kSurveyLane, 0, middle + 2});
  }

  void add_oncoming(double time) {
    const double lane = route_.side(survey_at(time), 1).lane_width;
    const Way way = {time, survey_at(time), -random_.uniform(5, 14), std::max(1.3, lane - 1.5)};
    if (random_.chance(0.12)) {
      add("motorcyclist", way, true, [&](const Brush& brush) { draw_motorcyclist(site(brush)); });
    } else {
      add_vehicle_on(way);
    }
  }

  void add_cyclist(double time) {
    const bool is_oncoming = random_.chance(0.5);
    const double lane = route_.side(survey_at(time), is_oncoming ? 1 : -1).lane_width;
    const double aside = is_oncoming ? lane - 0.6 : -std::max(lane - 0.4, 2.7);
    const double speed = random_.uniform(3.5, 7) * (is_oncoming ? -1 : 1);
    add("cyclist", {time, survey_at(time), speed, aside}, true, [&](const Brush& brush) { draw_cyclist(site(brush)); });
  }

  void add_walker(double time) {
    const WalkerKind& kind = any_walker();
    const double left = random_.chance(0.5) ? 1 : -1;
    const double along = survey_at(time) + random_.uniform(-8, 25);
    const double aside = left * (route_.side(along, left).pavement_offset() - random_.uniform(0.5, 1.1));
    const double speed = random_.uniform(kind.slowest, kind.fastest) * (random_.chance(0.5) ? 1 : -1);
    add(kind.name, {time, along, speed, aside}, false, [&](const Brush& brush) { kind.draw(site(brush)); });
  }

  // From one kerb to the other, out of the survey's way.
  void add_crossing(double time) {
    const WalkerKind& kind = any_walker();
    const double left = random_.chance(0.5) ? 1 : -1;
    const double speed = random_.uniform(kind.slowest, kind.fastest);
    const double half = route_.side(survey_at(time), left).kerb_offset() + 1;
    const double ahead = kFarFromSurvey + drive_.speed * half / speed;
    add(kind.name, {time, survey_at(time) + ahead, 0, 0, -left * speed, half / speed}, false,
        [&](const Brush& brush) { kind.draw(site(brush)); });
  }

  const WalkerKind& any_walker() {
    double choice = random_.uniform(0, 1);
    for (const WalkerKind& kind : kWalkers) {
      choice -= kind.share;
      if (choice < 0) return kind;
    }
    return kWalkers.front();
  }

  Site site(const Brush& brush) { return {brush, world_, random_, 2, 1, false}; }

  World& world_;
  const Route& route_;
  const DriveOptions& drive_;
  double duration_;
  const std::vector<Eigen::Vector2d>& obstacles_;
  int epoch_;
  Random random_;
  std::vector<Traffic::Mover> movers_;
};

}  // namespace

Traffic plan_traffic(World& world, const Route& route, const DriveOptions& drive, double duration,
                     const std::vector<Eigen::Vector2d>& obstacles, int epoch, std::uint64_t seed) {
  return Traffic(Planner(world, route, drive, duration, obstacles, epoch, seed).plan());
}

}  // namespace vdbmap::simulator
