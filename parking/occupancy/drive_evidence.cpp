// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/occupancy/drive_evidence.h"

#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "parking/segmentation/segment.h"

namespace vdbmap::parking {
namespace {

constexpr double kContext = 26;  // [m] around spaces: as far as the network looks, and a voxel of its coarsest level
constexpr double kFinest = 0.1;  // [m]

const VoxelLevel& level_of(const VoxelMap& map) {
  if (const VoxelLevel* level = find_level(map, kFinest)) return *level;
  throw std::invalid_argument("a drive is looked at in voxels of 0.1 m, which the map has not");
}

BuildOptions build_options(const MapFrame& frame) {
  BuildOptions options;
  options.voxel_sizes = {kFinest, 1.0};
  options.anchor = frame.anchor;
  options.epsg = frame.epsg;
  return options;
}

}  // namespace

// Which points of a drive matter: those near spaces.
class Surroundings {
 public:
  explicit Surroundings(std::span<const std::optional<SpaceColumns>> rooms) {
    for (const auto& room : rooms) {
      if (!room) continue;
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(room->radius() + kContext);
      boxes_.emplace_back(room->middle() - reach, room->middle() + reach);
      all_.extend(boxes_.back());
    }
  }

  bool contains(const Eigen::Vector3d& point) {
    const Eigen::Vector2d place = point.head<2>();
    if (boxes_.empty() || !all_.contains(place)) return false;
    if (boxes_[last_].contains(place)) return true;  // the next point is mostly near the one before
    for (last_ = 0; last_ < boxes_.size(); ++last_) {
      if (boxes_[last_].contains(place)) return true;
    }
    last_ = 0;
    return false;
  }

 private:
  std::vector<Eigen::AlignedBox2d> boxes_;
  Eigen::AlignedBox2d all_;
  std::size_t last_ = 0;
};

struct DriveEvidence::State {
  State(const VoxelMap& map, std::span<const ParkingSpace> all, const GroundPlan& ground)
      : before(level_of(map)),
        anchor(map.frame.anchor),
        spaces(all),
        rooms(rooms_over(all, ground)),
        surroundings(rooms),
        passed(rooms),
        builder(build_options(map.frame)) {}

  const VoxelLevel& before;
  Eigen::Vector3d anchor;
  std::span<const ParkingSpace> spaces;
  std::vector<std::optional<SpaceColumns>> rooms;
  Surroundings surroundings;
  PassedColumns passed;
  MapBuilder builder;
};

DriveEvidence::DriveEvidence(const VoxelMap& map, std::span<const ParkingSpace> spaces, const GroundPlan& ground)
    : state_(std::make_unique<State>(map, spaces, ground)) {}

DriveEvidence::~DriveEvidence() = default;

void DriveEvidence::add(const PosedCloud& scan) {
  const std::vector<MeasuredRay> rays = rays_of(scan, state_->anchor);
  state_->passed.add(rays);
  PointCloud near;
  for (const MeasuredRay& ray : rays) {
    if (state_->surroundings.contains(ray.end)) near.positions.push_back(ray.end + state_->anchor);
  }
  if (!near.empty()) state_->builder.add(near);
}

std::size_t DriveEvidence::num_points() const { return state_->builder.num_points(); }

std::pair<VoxelMap, EpochEvidence> DriveEvidence::finish(const NetworkWeights& network) {
  VoxelMap drive = state_->builder.finish();
  label_map(drive, network);
  EpochEvidence evidence;
  evidence.vehicles = find_vehicles(drive.finest());
  evidence.spaces =
      evidence_of(state_->spaces, state_->rooms, drive.finest(), state_->before, evidence.vehicles, state_->passed);
  return {std::move(drive), std::move(evidence)};
}

EpochEvidence evidence_of_level(std::span<const ParkingSpace> spaces, const GroundPlan& ground,
                                const VoxelLevel& before, const VoxelLevel& level,
                                const std::optional<Visibility>& visibility) {
  const std::vector<std::optional<SpaceColumns>> rooms = rooms_over(spaces, ground);
  PassedColumns passed(rooms);
  if (visibility) passed.add(SightFinder(level, *visibility), level.voxel_size());
  EpochEvidence evidence;
  evidence.vehicles = find_vehicles(level);
  evidence.spaces = evidence_of(spaces, rooms, level, before, evidence.vehicles, passed);
  return evidence;
}

}  // namespace vdbmap::parking
