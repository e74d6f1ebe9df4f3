// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/visibility.h"

#include <algorithm>
#include <cmath>

#include "vdbmap/core/parallel.h"

namespace vdbmap::simulator {
namespace {

constexpr double kPosePeriod = 0.5;  // [s]
constexpr int kMostSurfaces = 40;    // of the thing in the space that a ray passes

std::vector<Eigen::Vector3d> points_of(const Street& street, const ParkingSpace& space) {
  const StreetLayout& layout = street.layouts[space.street];
  const Eigen::Isometry3d frame =
      layout.place(space.station, layout.sides[space.side].sign * space.distance, space.yaw);
  std::vector<Eigen::Vector3d> points;
  for (const double x : {-0.4, -0.13, 0.13, 0.4}) {
    for (const double y : {-0.35, 0.0, 0.35}) {
      for (const double z : {0.25, 0.75, 1.3})
        points.emplace_back(frame * Eigen::Vector3d(x * space.length, y * space.width, z));
    }
  }
  return points;
}

// What stands in a space, or nothing.
std::optional<ObjectId> occupant(const Street& street, std::size_t space, int epoch) {
  const auto index = static_cast<std::size_t>(epoch);
  const auto& vehicle = street.parking.vehicle_in_space[index][space];
  if (vehicle) return street.parking.vehicles[*vehicle].object;
  if (street.parking.thing_in_space.empty()) return std::nullopt;
  return street.parking.thing_in_space[index][space];
}

bool is_seen(const SceneView& view, const Eigen::Isometry3d& scene_from_sensor, const Eigen::Vector3d& point,
             const FieldOfView& field, std::optional<ObjectId> through) {
  const Eigen::Vector3d to_point = point - scene_from_sensor.translation();
  const double distance = to_point.norm();
  if (distance > field.farthest) return false;
  const Eigen::Vector3d direction = to_point / distance;
  const double elevation = std::asin((scene_from_sensor.linear().transpose() * direction).z());
  if (elevation < field.lowest || elevation > field.highest) return false;
  Ray ray = {scene_from_sensor.translation(), direction, 0, distance};
  for (int i = 0; i < kMostSurfaces; ++i) {
    const std::optional<Hit> hit = view.first_hit(ray);
    if (!hit) return true;
    if (!through || view.triangle(hit->triangle).object != *through) return false;
    ray.nearest = hit->distance + 0.001;
  }
  return false;
}

}  // namespace

std::vector<double> space_visibility(const Street& street, int epoch, const SceneView& view, const Drive& drive,
                                     const FieldOfView& field) {
  std::vector<double> shares(street.parking.spaces.size());
  parallel_for(shares.size(), [&](std::size_t i) {
    const std::vector<Eigen::Vector3d> points = points_of(street, street.parking.spaces[i]);
    const std::optional<ObjectId> through = occupant(street, i, epoch);
    std::size_t num_seen = 0;
    for (const Eigen::Vector3d& point : points) {
      bool seen = false;
      for (double time = drive.start_time(); time <= drive.end_time() && !seen; time += kPosePeriod) {
        const Eigen::Isometry3d scene_from_sensor = drive.scene_from_vehicle(time) * field.vehicle_from_sensor;
        seen = is_seen(view.at(time), scene_from_sensor, point, field, through);
      }
      num_seen += seen ? 1 : 0;
    }
    shares[i] = static_cast<double>(num_seen) / static_cast<double>(points.size());
  });
  return shares;
}

}  // namespace vdbmap::simulator
