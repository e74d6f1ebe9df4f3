// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/free_kerb.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parking/spaces/outline.h"

namespace vdbmap::parking {
namespace {

constexpr double kShortestGap = 5.2;      // [m] into which one can park behind another car (RASt 06: 5.2 m)
constexpr double kUsualLength = 5.7;      // [m] of a space in a row of several
constexpr double kUsualWidth = 2.4;       // [m] where cars stand side by side
constexpr double kNarrowest = 1.9;        // [m]
constexpr double kSeenGround = 0.5;       // of the squares of a candidate
constexpr double kBlockedSquares = 0.05;  // more: something stands there
constexpr double kHeightReach = 2;        // [m]

ParkingSpace candidate_at(const Eigen::Vector2d& middle, double heading, double length, double width,
                          const KerbRow& row) {
  UprightBox box;
  box.center << middle, 0;
  box.length = length;
  box.width = width;
  box.heading = heading;
  const auto corners = box.corners();
  ParkingSpace space = space_of_outline({corners.begin(), corners.end()});
  space.is_candidate = true;
  space.angle = row.angle;
  space.kerb_side = row.side;
  return space;
}

bool is_free(const ParkingSpace& candidate, std::span<const ParkingSpace> spaces, const GroundPlan& ground) {
  const UprightBox box = box_of(candidate);
  for (const ParkingSpace& space : spaces) {
    if (shared_area(box, box_of(space)) > 0.05) return false;
  }
  const auto height = ground.height_near(box.center.head<2>(), candidate.length / 2 + kHeightReach);
  if (!height) return false;
  double num_squares = 0, num_seen = 0, num_blocked = 0;
  constexpr double kStep = GroundPlan::kSquare;
  for (double u = -box.length / 2 + kStep / 2; u < box.length / 2; u += kStep) {
    for (double v = -box.width / 2 + kStep / 2; v < box.width / 2; v += kStep) {
      const Eigen::Vector2d place = box.center.head<2>() + u * box.along() + v * box.across();
      num_squares += 1;
      num_seen += ground.height_at(place) ? 1 : 0;
      num_blocked += ground.is_blocked(place, *height) ? 1 : 0;
    }
  }
  return num_seen >= kSeenGround * num_squares && num_blocked <= kBlockedSquares * num_squares;
}

// The heading in the middle between two that differ by less than a quarter turn.
double middle_heading(double a, double b) { return a + std::remainder(b - a, std::numbers::pi) / 2; }

void fill_gap(const ParkingSpace& before, const ParkingSpace& after, const KerbRow& row,
              std::vector<ParkingSpace>& candidates) {
  const Eigen::Vector2d from = middle_of(before), to = middle_of(after), step = to - from;
  const Eigen::Vector2d along = step.normalized();
  const double begin = half_extent(before, along), gap = step.norm() - begin - half_extent(after, along);
  const double heading = middle_heading(before.heading, after.heading);
  const double width = std::max(kNarrowest, (before.width + after.width) / 2);
  const bool is_parallel = row.angle == ParkingAngle::kParallel;
  const double turned = std::abs(std::sin(heading - std::atan2(along.y(), along.x())));
  const double least = is_parallel ? kShortestGap : kUsualWidth / turned;
  const double usual = is_parallel ? kUsualLength : least;
  if (gap < least) return;
  const auto count = static_cast<int>(std::max(1.0, std::floor(gap / usual)));
  for (int i = 0; i < count; ++i) {
    const double size = gap / count;
    const Eigen::Vector2d middle = from + (begin + (i + 0.5) * size) * along;
    candidates.push_back(is_parallel ? candidate_at(middle, heading, std::min(size, kUsualLength), width, row)
                                     : candidate_at(middle, heading, (before.length + after.length) / 2,
                                                    std::min(size * turned, kUsualWidth), row));
  }
}

}  // namespace

std::vector<ParkingSpace> find_free_kerb(std::span<const ParkingSpace> spaces, std::span<const KerbRow> rows,
                                         const GroundPlan& ground) {
  std::vector<ParkingSpace> candidates;
  for (const KerbRow& row : rows) {
    for (std::size_t i = 0; i + 1 < row.spaces.size(); ++i) {
      fill_gap(spaces[row.spaces[i]], spaces[row.spaces[i + 1]], row, candidates);
    }
  }
  std::vector<ParkingSpace> free;
  for (ParkingSpace& candidate : candidates) {
    if (!is_free(candidate, spaces, ground) || !is_free(candidate, free, ground)) continue;
    candidate.ground = ground.height_near(middle_of(candidate), candidate.length / 2 + kHeightReach);
    free.push_back(std::move(candidate));
  }
  return free;
}

}  // namespace vdbmap::parking
