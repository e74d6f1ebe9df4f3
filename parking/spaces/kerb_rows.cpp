// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/kerb_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>

#include <Eigen/Eigenvalues>

namespace vdbmap::parking {
namespace {

using std::numbers::pi;

constexpr double kStreetReach = 40;    // [m] spaces within that far show where the street goes
constexpr double kLongerThanWide = 2;  // times, or spaces show no direction (standard deviations)
constexpr double kAlongKerb = pi / 6;  // [rad] from the street's direction: parallel; from across it: perpendicular
constexpr double kSameHeading = 0.26;  // [rad]
constexpr double kLongestGap = 25;     // [m]
constexpr double kAcross = 1;          // [m]
constexpr double kBend = 0.03;         // of the distance
constexpr double kKerbHeight = 0.04;   // [m] less is the road's crown
constexpr double kNearest = 0.4, kFarthest = 2.2, kAsFar = 4.5;  // [m] from a space: strips that are looked at
constexpr std::size_t kFewestOfKerb = 3;                         // spaces
constexpr double kBesideKerb = 1.8;                              // [m] across: less is the same kerb
constexpr double kOtherRowFrom = 4, kOtherRowTo = 16;            // [m] across the road

double angle_between(double a, double b) { return std::abs(std::remainder(a - b, pi)); }

double heading_of(const Eigen::Vector2d& direction) { return std::atan2(direction.y(), direction.x()); }

Eigen::Vector2d left_of(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

Eigen::Vector2d forward(Eigen::Vector2d direction) {
  const bool is_north = std::abs(direction.x()) < 1e-9;
  return (is_north ? direction.y() < 0 : direction.x() < 0) ? Eigen::Vector2d(-direction) : direction;
}

// Where spaces are spread around a place; nothing where they are in no direction.
std::optional<Eigen::Vector2d> spread_direction(std::span<const Eigen::Vector2d> middles,
                                                const Eigen::Vector2d& place) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  double count = 0;
  for (const Eigen::Vector2d& middle : middles) {
    if ((middle - place).norm() > kStreetReach) continue;
    ++count;
    const Eigen::Vector2d step = middle - mean;
    mean += step / count;
    scatter += step * (middle - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
  const Eigen::Vector2d squares = solver.eigenvalues();
  if (!(squares[1] > 0 && squares[1] >= kLongerThanWide * kLongerThanWide * squares[0])) return std::nullopt;
  return solver.eigenvectors().col(1);
}

// The mean heading of the spaces around a place that differs least from `heading`; nothing where none is near it.
std::optional<double> mean_heading(std::span<const ParkingSpace> spaces, std::span<const Eigen::Vector2d> middles,
                                   const Eigen::Vector2d& place, double heading) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const double turned = std::remainder(spaces[i].heading - heading, pi);
    if ((middles[i] - place).norm() > kStreetReach || std::abs(turned) > kAlongKerb) continue;
    sum += turned;
    ++count;
  }
  return count > 0 ? std::optional(heading + sum / count) : std::nullopt;
}

// Where the street goes around a space: roughly where spaces are spread, which a car park beside it turns, and exactly
// as the cars stand that are parallel to that, else across.
Eigen::Vector2d street_direction(std::span<const ParkingSpace> spaces, std::span<const Eigen::Vector2d> middles,
                                 std::size_t number) {
  const Eigen::Vector2d& place = middles[number];
  const auto spread = spread_direction(middles, place);
  const double heading = spread ? heading_of(*spread) : spaces[number].heading;
  const auto along = mean_heading(spaces, middles, place, heading);
  const auto across = along ? std::nullopt : mean_heading(spaces, middles, place, heading + pi / 2);
  const double exact = along ? *along : across ? *across - pi / 2 : heading;
  return forward({std::cos(exact), std::sin(exact)});
}

ParkingAngle angle_to(const ParkingSpace& space, const Eigen::Vector2d& street) {
  const double turned = angle_between(space.heading, heading_of(street));
  if (turned < kAlongKerb) return ParkingAngle::kParallel;
  return turned > pi / 2 - kAlongKerb ? ParkingAngle::kPerpendicular : ParkingAngle::kAngled;
}

// The groups that links make.
class Groups {
 public:
  explicit Groups(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), std::size_t{0}); }

  std::size_t of(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void link(std::size_t a, std::size_t b) {
    const auto [low, high] = std::minmax({of(a), of(b)});
    parents_[high] = low;
  }

 private:
  std::vector<std::size_t> parents_;
};

// What is seen beside a row, on its left and on its right.
struct Sides {
  std::array<double, 2> heights = {0, 0};              // [m] sums over places with ground
  std::array<double, 2> num_near = {0, 0};             // of such places
  std::array<double, 2> num_far = {0, 0};              // farther away too
  std::array<std::size_t, 2> num_other_rows = {0, 0};  // spaces across the road
};

void look_beside(const ParkingSpace& space, const Eigen::Vector2d& middle, const Eigen::Vector2d& direction,
                 const GroundPlan& ground, Sides& sides) {
  const double along = half_extent(space, direction), across = half_extent(space, left_of(direction));
  for (const int side : {0, 1}) {
    const Eigen::Vector2d outwards = (side == 0 ? 1 : -1) * left_of(direction);
    for (double u = -along; u <= along; u += GroundPlan::kSquare) {
      for (double away = kNearest; away <= kAsFar; away += GroundPlan::kSquare) {
        const auto height = ground.height_at(middle + u * direction + (across + away) * outwards);
        if (!height) continue;
        const auto i = static_cast<std::size_t>(side);
        sides.num_far[i] += 1;
        if (away > kFarthest) continue;
        sides.heights[i] += *height;
        sides.num_near[i] += 1;
      }
    }
  }
}

// The side of the row on which the road is: 1 its left, -1 its right, 0 unknown.
int side_of_road(const Sides& sides) {
  double votes = 0;
  if (sides.num_near[0] > 0 && sides.num_near[1] > 0) {
    const double step = sides.heights[0] / sides.num_near[0] - sides.heights[1] / sides.num_near[1];
    if (std::abs(step) > kKerbHeight) votes += step < 0 ? 2 : -2;
  }
  if (sides.num_other_rows[0] != sides.num_other_rows[1]) {
    votes += sides.num_other_rows[0] > sides.num_other_rows[1] ? 2 : -2;
  }
  if (sides.num_far[0] != sides.num_far[1]) votes += sides.num_far[0] > sides.num_far[1] ? 1 : -1;
  return votes > 0 ? 1 : votes < 0 ? -1 : 0;
}

std::string compass_of(const Eigen::Vector2d& direction) {
  static constexpr std::array kNames = {"E", "NE", "N", "NW", "W", "SW", "S", "SE"};
  const auto sector = std::lround(heading_of(direction) / (pi / 4));
  return kNames[static_cast<std::size_t>((sector + 8) % 8)];
}

std::string side_of(const KerbRow& row, std::span<const ParkingSpace> spaces, std::span<const Eigen::Vector2d> middles,
                    const GroundPlan& ground) {
  Sides sides;
  const Eigen::Vector2d left = left_of(row.direction);
  for (const std::size_t i : row.spaces) {
    look_beside(spaces[i], middles[i], row.direction, ground, sides);
    for (std::size_t k = 0; k < spaces.size(); ++k) {
      const Eigen::Vector2d step = middles[k] - middles[i];
      const double across = std::abs(step.dot(left));
      if (std::abs(step.dot(row.direction)) > kStreetReach / 2 || across < kOtherRowFrom || across > kOtherRowTo) {
        continue;
      }
      ++sides.num_other_rows[step.dot(left) > 0 ? 0 : 1];
    }
  }
  const int road = side_of_road(sides);
  return road == 0 ? "" : compass_of(-road * left);
}

}  // namespace

Eigen::Vector2d middle_of(const ParkingSpace& space) { return box_of(space).center.head<2>(); }

double half_extent(const ParkingSpace& space, const Eigen::Vector2d& direction) {
  const double turned = heading_of(direction) - space.heading;
  return (std::abs(std::cos(turned)) * space.length + std::abs(std::sin(turned)) * space.width) / 2;
}

bool is_in_lane(const KerbRow& row, std::span<const KerbRow> rows, std::span<const ParkingSpace> spaces) {
  if (row.angle != ParkingAngle::kParallel || row.spaces.size() >= kFewestOfKerb) return false;
  const Eigen::Vector2d place = middle_of(spaces[row.spaces.front()]), left = left_of(row.direction);
  std::array<bool, 2> has_kerb = {false, false};
  for (const KerbRow& other : rows) {
    if (other.spaces.size() < kFewestOfKerb) continue;
    for (const std::size_t i : other.spaces) {
      const Eigen::Vector2d step = middle_of(spaces[i]) - place;
      const double across = step.dot(left);
      if (std::abs(step.dot(row.direction)) > kStreetReach / 2 || std::abs(across) > kOtherRowTo) continue;
      if (std::abs(across) > kBesideKerb) has_kerb[across > 0 ? 0 : 1] = true;
    }
  }
  return has_kerb[0] && has_kerb[1];
}

std::vector<KerbRow> find_kerb_rows(std::span<const ParkingSpace> spaces, const GroundPlan& ground) {
  std::vector<Eigen::Vector2d> middles, streets;
  std::vector<ParkingAngle> angles;
  for (const ParkingSpace& space : spaces) middles.push_back(middle_of(space));
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    streets.push_back(street_direction(spaces, middles, i));
    angles.push_back(angle_to(spaces[i], streets[i]));
  }

  Groups groups(spaces.size());
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    for (std::size_t k = i + 1; k < spaces.size(); ++k) {
      if (angles[i] != angles[k] || angle_between(spaces[i].heading, spaces[k].heading) > kSameHeading) continue;
      const double opposite = streets[i].dot(streets[k]) < 0 ? -1 : 1;
      const Eigen::Vector2d street = (streets[i] + opposite * streets[k]).normalized(), step = middles[k] - middles[i];
      const double along = std::abs(step.dot(street)), across = std::abs(step.dot(left_of(street)));
      const double gap = along - half_extent(spaces[i], street) - half_extent(spaces[k], street);
      if (gap < kLongestGap && across < kAcross + kBend * along) groups.link(i, k);
    }
  }

  std::map<std::size_t, KerbRow> rows;  // by their first spaces
  for (std::size_t i = 0; i < spaces.size(); ++i) rows[groups.of(i)].spaces.push_back(i);
  std::vector<KerbRow> result;
  for (auto& entry : rows) {
    const std::size_t first = entry.first;
    KerbRow& row = entry.second;
    row.angle = angles[first];
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const std::size_t i : row.spaces) sum += (streets[i].dot(streets[first]) < 0 ? -1 : 1) * streets[i];
    row.direction = forward(sum.normalized());
    std::ranges::sort(row.spaces, {}, [&](std::size_t i) { return middles[i].dot(row.direction); });
    row.side = side_of(row, spaces, middles, ground);
    result.push_back(std::move(row));
  }
  return result;
}

}  // namespace vdbmap::parking
