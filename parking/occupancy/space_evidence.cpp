// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/occupancy/space_evidence.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::parking {
namespace {

constexpr double kPlaneReach = 2.5;                            // [m] beyond the middle of a space's short side
constexpr double kFarReach = 10;                               // [m] where there is no ground nearer
constexpr double kLowestVehicle = 0.2, kHighestVehicle = 2.5;  // [m] above the ground
constexpr int kFewestEmpty = 5;                                // voxels of a column: a ray through it sees so many
constexpr double kStandsIn = 0.1;                              // of the smaller area; less is beside the space
constexpr double kStandsInToo = 0.34;                          // of the smaller area
constexpr double kBoxMargin = 0.3;                             // [m] around a box: mirrors
constexpr double kTile = 16;                                   // [m] of a table of spaces

// Which spaces may hold a place: a table of squares.
class SpaceTable {
 public:
  explicit SpaceTable(std::span<const std::optional<SpaceColumns>> rooms) {
    for (std::size_t i = 0; i < rooms.size(); ++i) {
      if (!rooms[i]) continue;
      const Eigen::Vector2d& middle = rooms[i]->middle();
      const double radius = rooms[i]->radius();
      for (auto x = tile(middle.x() - radius); x <= tile(middle.x() + radius); ++x) {
        for (auto y = tile(middle.y() - radius); y <= tile(middle.y() + radius); ++y) spaces_[key(x, y)].push_back(i);
      }
    }
  }

  std::span<const std::size_t> near(const Eigen::Vector3d& place) const {
    const auto found = spaces_.find(key(tile(place.x()), tile(place.y())));
    return found == spaces_.end() ? std::span<const std::size_t>() : found->second;
  }

 private:
  static std::int64_t tile(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate / kTile)); }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) << 32 ^ (static_cast<std::uint64_t>(y) & 0xffffffff);
  }

  std::unordered_map<std::uint64_t, std::vector<std::size_t>> spaces_;
};

// A vehicle and the spaces it stands in.
struct Standing {
  UprightBox box;  // with its margin
  std::vector<std::size_t> spaces;
};

std::vector<Standing> find_standing(std::span<const ParkingSpace> spaces, std::span<const Vehicle> vehicles,
                                    std::vector<SpaceEvidence>& evidence) {
  std::vector<UprightBox> boxes;
  for (const ParkingSpace& space : spaces) boxes.push_back(box_of(space));
  std::vector<Standing> standing;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    Standing vehicle{vehicles[i].box, {}};
    std::vector<std::pair<double, std::size_t>> shares;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const double share = shared_area(vehicles[i].box, boxes[k]);
      if (share >= kStandsIn) shares.emplace_back(share, k);
    }
    std::ranges::sort(shares, std::greater());
    for (const auto& [share, space] : shares) {
      if (!vehicle.spaces.empty() && share < kStandsInToo) continue;
      vehicle.spaces.push_back(space);
      if (share <= evidence[space].vehicle_share) continue;
      evidence[space].vehicle = i;
      evidence[space].vehicle_share = share;
    }
    vehicle.box.length += 2 * kBoxMargin;
    vehicle.box.width += 2 * kBoxMargin;
    standing.push_back(std::move(vehicle));
  }
  return standing;
}

// Whether a place of a space belongs to a vehicle that stands in others.
bool is_of_neighbor(const Eigen::Vector2d& place, std::size_t space, std::span<const Standing* const> near) {
  bool is_of_other = false;
  for (const Standing* vehicle : near) {
    if (vehicle->spaces.empty() || !vehicle->box.contains(place)) continue;
    if (std::ranges::find(vehicle->spaces, space) != vehicle->spaces.end()) return false;
    is_of_other = true;
  }
  return is_of_other;
}

struct SeenVoxel {
  Eigen::Vector3d mean;
  std::uint32_t count;
  bool is_vehicle;
  bool is_thing;  // of the class that has no name
};

const std::vector<std::int32_t>& labels_of(const VoxelLevel& level) {
  const std::vector<std::int32_t>& labels = level.channels().labels;
  if (labels.size() != level.size()) throw std::invalid_argument("a level without labels says nothing of vehicles");
  return labels;
}

// Tells where vehicles stood before.
class VehiclesBefore {
 public:
  explicit VehiclesBefore(const VoxelLevel& level) : level_(level), labels_(labels_of(level)), finder_(level) {}

  bool has_near(const VoxelIndex& voxel) const {
    bool has_vehicle = false;
    finder_.for_each_around(voxel, 1, [&](const VoxelIndex&, const VoxelRecord& record) {
      const auto number = static_cast<std::size_t>(&record - level_.records().data());
      has_vehicle = has_vehicle || surface_class_of(labels_[number]) == SurfaceClass::kVehicle;
    });
    return has_vehicle;
  }

 private:
  const VoxelLevel& level_;
  const std::vector<std::int32_t>& labels_;
  VoxelFinder finder_;
};

// The voxels of vehicles and other things that may stand in each space.
std::vector<std::vector<SeenVoxel>> voxels_by_space(std::span<const std::optional<SpaceColumns>> rooms,
                                                    const VoxelLevel& level, const VoxelLevel& before) {
  const std::vector<std::int32_t>& labels = labels_of(level);
  if (before.voxel_size() != level.voxel_size()) throw std::invalid_argument("levels of two voxel sizes");
  const VehiclesBefore vehicles_before(before);
  const SpaceTable table(rooms);
  std::vector<std::vector<SeenVoxel>> voxels(rooms.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const Eigen::Vector3d center = center_of_voxel(voxel, level.voxel_size());
    const std::span<const std::size_t> near = table.near(center);
    if (near.empty()) return;
    const std::optional<SurfaceClass> surface = surface_class_of(labels[number]);
    if (!surface || *surface == SurfaceClass::kGround) return;
    const bool is_vehicle = *surface == SurfaceClass::kVehicle || vehicles_before.has_near(voxel);
    const VoxelRecord& record = level.records()[number];
    for (const std::size_t space : near) {
      voxels[space].push_back({mean_of(record, voxel, level.voxel_size()), record.count, is_vehicle,
                               !is_vehicle && *surface == SurfaceClass::kOther});
    }
  });
  return voxels;
}

void count_voxels(std::size_t space, const SpaceColumns& room, std::span<const SeenVoxel> voxels,
                  std::span<const Standing* const> near, SpaceEvidence& evidence) {
  std::vector<std::uint8_t> has_vehicle(room.size()), has_other(room.size()), has_thing(room.size());
  for (const SeenVoxel& voxel : voxels) {
    const Eigen::Vector3d place = room.in_frame(voxel.mean);
    const std::optional<std::size_t> column = room.column_at(place.x(), place.y());
    if (!column) continue;
    if (!voxel.is_vehicle) {
      if (place.z() < SpaceColumns::kLow || place.z() > SpaceColumns::kHigh) continue;
      has_other[*column] = 1;
      if (!voxel.is_thing || !room.is_inner(*column) || is_of_neighbor(voxel.mean.head<2>(), space, near)) continue;
      has_thing[*column] = 1;
      evidence.thing_points += voxel.count;
      evidence.thing_height = std::max(evidence.thing_height, place.z());
      continue;
    }
    if (place.z() < kLowestVehicle || place.z() > kHighestVehicle) continue;
    evidence.vehicle_points += voxel.count;
    if (is_of_neighbor(voxel.mean.head<2>(), space, near)) {
      evidence.neighbor_points += voxel.count;
    } else {
      has_vehicle[*column] = 1;
    }
  }
  evidence.num_with_vehicle = static_cast<std::size_t>(std::ranges::count(has_vehicle, 1));
  evidence.num_with_thing = static_cast<std::size_t>(std::ranges::count(has_thing, 1));
  evidence.num_with_other = static_cast<std::size_t>(std::ranges::count(has_other, 1));
}

}  // namespace

std::vector<std::optional<SpaceColumns>> rooms_over(std::span<const ParkingSpace> spaces, const GroundPlan& ground) {
  std::vector<std::optional<SpaceColumns>> rooms;
  for (const ParkingSpace& space : spaces) {
    const Eigen::Vector2d middle = box_of(space).center.head<2>();
    std::optional<GroundPlane> plane = ground.plane_around(middle, space.length / 2 + kPlaneReach);
    if (!plane) plane = ground.plane_around(middle, kFarReach);
    rooms.push_back(plane ? std::optional(SpaceColumns(space, *plane)) : std::nullopt);
  }
  return rooms;
}

PassedColumns::PassedColumns(std::span<const std::optional<SpaceColumns>> rooms)
    : rooms_(rooms), counts_(rooms.size()) {
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const std::size_t size = rooms[i] ? rooms[i]->size() : 0;
    counts_[i] = {std::vector<std::uint8_t>(size), std::vector<std::uint8_t>(size)};
  }
}

void PassedColumns::add(std::span<const MeasuredRay> rays) {
  parallel_for(rooms_.size(), [&](std::size_t i) {
    if (!rooms_[i]) return;
    const SpaceColumns& room = *rooms_[i];
    Counts& counts = counts_[i];
    for (const MeasuredRay& ray : rays) {
      // In plan first: most rays go elsewhere.
      const Eigen::Vector2d step = (ray.end - ray.origin).head<2>(), to_room = room.middle() - ray.origin.head<2>();
      const double square = step.squaredNorm(), along = step.dot(to_room);
      const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
      if ((to_room - share * step).squaredNorm() > room.radius() * room.radius()) continue;
      const double length = (ray.end - ray.origin).norm();
      if (length <= kClearance) continue;
      const Eigen::Vector3d end = ray.origin + (1 - kClearance / length) * (ray.end - ray.origin);
      bool is_through = false;
      room.for_each_passed(ray.origin, end, SpaceColumns::kHigh, [&](std::size_t column) {
        counts.is_passed[column] = 1;
        is_through = true;
      });
      if (is_through) {
        room.for_each_passed(ray.origin, end, SpaceColumns::kSill,
                             [&](std::size_t column) { counts.is_passed_low[column] = 1; });
      }
      counts.num_rays += is_through ? 1 : 0;
    }
  });
}

void PassedColumns::add(const SightFinder& sight, double voxel_size) {
  for (std::size_t i = 0; i < rooms_.size(); ++i) {
    if (!rooms_[i]) continue;
    const SpaceColumns& room = *rooms_[i];
    std::vector<int> num_empty(room.size()), num_empty_low(room.size());
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(room.radius());
    const double ground_low = room.lowest_ground(), ground_high = room.highest_ground();
    const auto corner = [&](const Eigen::Vector2d& plan, double height) {
      return voxel_of_point({plan.x(), plan.y(), height}, 1 / voxel_size);
    };
    const VoxelIndex low = corner(room.middle() - reach, ground_low + SpaceColumns::kLow),
                     high = corner(room.middle() + reach, ground_high + SpaceColumns::kHigh);
    for (std::int32_t x = low.x(); x <= high.x(); ++x) {
      for (std::int32_t y = low.y(); y <= high.y(); ++y) {
        for (std::int32_t z = low.z(); z <= high.z(); ++z) {
          const Eigen::Vector3d place = room.in_frame(center_of_voxel({x, y, z}, voxel_size));
          if (place.z() < SpaceColumns::kLow || place.z() > SpaceColumns::kHigh) continue;
          const std::optional<std::size_t> column = room.column_at(place.x(), place.y());
          if (!column || sight.find({x, y, z}) != Sight::kEmpty) continue;
          ++num_empty[*column];
          num_empty_low[*column] += place.z() < SpaceColumns::kSill ? 1 : 0;
        }
      }
    }
    for (std::size_t k = 0; k < num_empty.size(); ++k) {
      if (num_empty[k] >= kFewestEmpty) counts_[i].is_passed[k] = 1;
      if (num_empty_low[k] >= kFewestEmpty) counts_[i].is_passed_low[k] = 1;
    }
  }
}

std::size_t PassedColumns::num_passed(std::size_t space) const {
  return static_cast<std::size_t>(std::ranges::count(counts_[space].is_passed, 1));
}

std::size_t PassedColumns::num_passed_low(std::size_t space) const {
  return static_cast<std::size_t>(std::ranges::count(counts_[space].is_passed_low, 1));
}

std::vector<SpaceEvidence> evidence_of(std::span<const ParkingSpace> spaces,
                                       std::span<const std::optional<SpaceColumns>> rooms, const VoxelLevel& level,
                                       const VoxelLevel& before, std::span<const Vehicle> vehicles,
                                       const PassedColumns& passed) {
  std::vector<SpaceEvidence> evidence(spaces.size());
  const std::vector<Standing> standing = find_standing(spaces, vehicles, evidence);
  const std::vector<std::vector<SeenVoxel>> voxels = voxels_by_space(rooms, level, before);
  parallel_for(spaces.size(), [&](std::size_t i) {
    if (!rooms[i]) return;
    SpaceEvidence& space = evidence[i];
    space.is_in_map = true;
    space.num_columns = rooms[i]->size();
    space.num_passed = passed.num_passed(i);
    space.num_passed_low = passed.num_passed_low(i);
    space.rays_through = passed.num_rays(i);
    std::vector<const Standing*> near;
    for (const Standing& vehicle : standing) {
      const double reach = rooms[i]->radius() + (vehicle.box.length + vehicle.box.width) / 2;
      if ((vehicle.box.center.head<2>() - rooms[i]->middle()).norm() < reach) near.push_back(&vehicle);
    }
    count_voxels(i, *rooms[i], voxels[i], near, space);
  });
  return evidence;
}

}  // namespace vdbmap::parking
