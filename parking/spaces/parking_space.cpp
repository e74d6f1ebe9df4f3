// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/spaces/parking_space.h"

#include <algorithm>
#include <array>
#include <utility>

namespace vdbmap::parking {
namespace {

template <typename Value, std::size_t kCount>
using Names = std::array<std::pair<Value, std::string_view>, kCount>;

constexpr Names<SpaceState, 3> kStates = {
    {{SpaceState::kUnknown, "unknown"}, {SpaceState::kVacant, "vacant"}, {SpaceState::kOccupied, "occupied"}}};
constexpr Names<ParkingAngle, 4> kAngles = {{{ParkingAngle::kUnknown, ""},
                                             {ParkingAngle::kParallel, "parallel"},
                                             {ParkingAngle::kPerpendicular, "perpendicular"},
                                             {ParkingAngle::kAngled, "angled"}}};

template <typename Value, std::size_t kCount>
std::string_view name_in(const Names<Value, kCount>& names, Value value) {
  return std::ranges::find(names, value, &std::pair<Value, std::string_view>::first)->second;
}

template <typename Value, std::size_t kCount>
std::optional<Value> value_in(const Names<Value, kCount>& names, std::string_view text) {
  const auto found = std::ranges::find(names, text, &std::pair<Value, std::string_view>::second);
  return found == names.end() ? std::nullopt : std::optional(found->first);
}

}  // namespace

std::string_view text_of(SpaceState state) { return name_in(kStates, state); }

std::optional<SpaceState> space_state_of(std::string_view text) { return value_in(kStates, text); }

std::string_view text_of(ParkingAngle angle) { return name_in(kAngles, angle); }

std::optional<ParkingAngle> parking_angle_of(std::string_view text) { return value_in(kAngles, text); }

UprightBox box_of(const ParkingSpace& space) {
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& corner : space.outline) corners.emplace_back(corner.x(), corner.y(), 0);
  return smallest_box(corners);
}

ParkingSpace space_of_outline(std::vector<Eigen::Vector2d> outline) {
  ParkingSpace space;
  space.outline = std::move(outline);
  const UprightBox box = box_of(space);
  space.length = box.length;
  space.width = box.width;
  space.heading = box.heading;
  return space;
}

double shared_area(const UprightBox& a, const UprightBox& b) {
  if ((a.center - b.center).head<2>().norm() > (a.length + a.width + b.length + b.width) / 2) return 0;
  const double areas = a.length * a.width + b.length * b.width, overlap = overlap_in_plan(a, b);
  const double intersection = areas * overlap / (1 + overlap);
  return intersection / std::min(a.length * a.width, b.length * b.width);
}

}  // namespace vdbmap::parking
