// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/objects/vehicles.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/voxel_groups.h"

namespace vdbmap::parking {
namespace {

constexpr double kGroupReach = 0.5;       // [m]
constexpr std::size_t kFewestVoxels = 8;  // of a vehicle

constexpr double kLongestCar = 5.6;    // [m] what is no longer and no wider is not cut
constexpr double kWidestCar = 2.6;     // [m]
constexpr double kShortestPart = 1.4;  // [m] of what is cut: a car's width, where several stand side by side
constexpr double kSlab = 0.2;          // [m] of a profile: none within a vehicle is empty by chance
constexpr double kGapHeight = 0.35;    // of the height on both sides: lower is a gap

constexpr double kUsualWidth = 1.8;   // [m] of cars
constexpr double kUsualLength = 4.4;  // [m]
constexpr double kNarrowest = 1.5;    // [m] what is narrower was not seen as a whole
constexpr double kShortest = 3.0;     // [m] and what is shorter
constexpr double kWidestEnd = 2.3;    // [m] what is not even that long is a front or a back
constexpr double kBeside = 1.0;       // [m] strip beside a box in which ground is looked for
constexpr double kGroundReach = 0.4;  // [m] up and down

struct Range {
  double low, high;
};
constexpr Range kPlausibleLength = {2.2, 13}, kPlausibleWidth = {1.2, 2.8}, kPlausibleHeight = {0.7, 4.2};

// The voxels of one vehicle, or of several that touch.
struct Cluster {
  VoxelGroup voxels;
  std::vector<Eigen::Vector3d> means;  // [m] in their order
};

// How high a cluster reaches above its lowest voxel in slabs across one direction.
struct Profile {
  double begin = 0;             // [m] along the direction
  std::vector<double> heights;  // [m] of each slab; 0 where it is empty
};

Profile profile_along(const Cluster& cluster, const Eigen::Vector2d& direction) {
  double low = std::numeric_limits<double>::infinity(), high = -low, bottom = low;
  for (const Eigen::Vector3d& mean : cluster.means) {
    const double along = mean.head<2>().dot(direction);
    low = std::min(low, along);
    high = std::max(high, along);
    bottom = std::min(bottom, mean.z());
  }
  Profile profile{low, std::vector<double>(static_cast<std::size_t>((high - low) / kSlab) + 1, 0.0)};
  for (const Eigen::Vector3d& mean : cluster.means) {
    const auto slab = static_cast<std::size_t>((mean.head<2>().dot(direction) - low) / kSlab);
    profile.heights[slab] = std::max(profile.heights[slab], mean.z() - bottom + kSlab);
  }
  return profile;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Where to cut a profile [m along its direction]: the middle of the lowest run of slabs that is a gap.
std::optional<double> gap_of(const Profile& profile) {
  const auto margin = static_cast<std::size_t>(kShortestPart / kSlab);
  const std::size_t size = profile.heights.size();
  std::optional<std::size_t> best;
  for (std::size_t i = margin; i + margin < size; ++i) {
    if (!best || profile.heights[i] < profile.heights[*best]) best = i;
  }
  if (!best) return std::nullopt;
  const auto begin = profile.heights.begin(), place = begin + static_cast<std::ptrdiff_t>(*best);
  const double before = median_of({begin, place}), after = median_of({place + 1, profile.heights.end()});
  if (*place > kGapHeight * std::min(before, after)) return std::nullopt;
  std::size_t last = *best;
  while (last + 1 < size && profile.heights[last + 1] == *place) ++last;
  return profile.begin + kSlab * (0.5 * static_cast<double>(*best + last) + 0.5);
}

std::pair<Cluster, Cluster> cut(const Cluster& cluster, const Eigen::Vector2d& direction, double place) {
  std::pair<Cluster, Cluster> parts;
  for (std::size_t i = 0; i < cluster.voxels.size(); ++i) {
    Cluster& part = cluster.means[i].head<2>().dot(direction) < place ? parts.first : parts.second;
    part.voxels.push_back(cluster.voxels[i]);
    part.means.push_back(cluster.means[i]);
  }
  return parts;
}

void split(Cluster cluster, std::vector<Cluster>& vehicles) {
  if (cluster.voxels.size() < kFewestVoxels) return;
  const UprightBox box = smallest_box(cluster.means);
  if (box.length > kLongestCar || box.width > kWidestCar) {
    for (const Eigen::Vector2d& direction : {box.along(), box.across()}) {
      const std::optional<double> place = gap_of(profile_along(cluster, direction));
      if (!place) continue;
      auto [before, after] = cut(cluster, direction, *place);
      split(std::move(before), vehicles);
      split(std::move(after), vehicles);
      return;
    }
  }
  vehicles.push_back(std::move(cluster));
}

// Tells on which side of a box the ground was seen: what is behind a vehicle is hidden.
class GroundFinder {
 public:
  explicit GroundFinder(const VoxelLevel& level) : level_(level), finder_(level) {}

  // Number of ground voxels in a strip that begins at an edge, from one corner to the other, and goes outwards.
  std::size_t num_beside(const UprightBox& box, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                         const Eigen::Vector2d& outwards) const {
    const double size = level_.voxel_size(), bottom = box.center.z() - box.height / 2;
    const double length = (to - from).norm();
    std::size_t count = 0;
    for (double along = 0; along < length; along += size) {
      for (double away = 2 * size; away < kBeside; away += size) {
        const Eigen::Vector2d place = from + along / length * (to - from) + away * outwards;
        count += has_ground({place.x(), place.y(), bottom}) ? 1 : 0;
      }
    }
    return count;
  }

 private:
  bool has_ground(const Eigen::Vector3d& place) const {
    const VoxelIndex middle = voxel_of_point(place, 1 / level_.voxel_size());
    const auto reach = static_cast<std::int32_t>(std::lround(kGroundReach / level_.voxel_size()));
    for (std::int32_t step = -reach; step <= reach; ++step) {
      const VoxelRecord* record = finder_.find(middle.offsetBy(0, 0, step));
      if (record == nullptr) continue;
      const auto number = static_cast<std::size_t>(record - level_.records().data());
      if (surface_class_of(level_.channels().labels[number]) == SurfaceClass::kGround) return true;
    }
    return false;
  }

  const VoxelLevel& level_;
  VoxelFinder finder_;
};

// Makes a box wider, away from the side on which more ground was seen.
void widen(UprightBox& box, double width, const GroundFinder& ground) {
  const auto [back_right, front_right, front_left, back_left] = box.corners();
  const std::size_t right = ground.num_beside(box, back_right, front_right, -box.across());
  const std::size_t left = ground.num_beside(box, back_left, front_left, box.across());
  const double side = left <= right ? 1 : -1;
  box.center.head<2>() += side * (width - box.width) / 2 * box.across();
  box.width = width;
}

// Lets length and width change places.
void turn(UprightBox& box) {
  std::swap(box.length, box.width);
  box.heading += box.heading < std::numbers::pi / 2 ? std::numbers::pi / 2 : -std::numbers::pi / 2;
}

// Makes a box wider or longer where its size says that one side only, or one end, was seen.
bool complete(UprightBox& box, const GroundFinder& ground) {
  const bool is_end = box.length < kWidestEnd;
  const bool is_side = !is_end && box.width < kNarrowest;
  const bool is_short = !is_end && box.length < kShortest;
  if (is_side) widen(box, kUsualWidth, ground);
  if (is_end) widen(box, kUsualLength, ground);
  if (is_short) {
    turn(box);
    widen(box, kUsualLength, ground);
  }
  if (is_end || is_short) turn(box);
  return is_end || is_side || is_short;
}

std::string doubt_about(double size, const Range& range, const char* what) {
  if (size >= range.low && size <= range.high) return "";
  std::ostringstream text;
  text << what << std::fixed << std::setprecision(1) << ' ' << size << " m, vehicles have " << range.low << " to "
       << range.high << " m";
  return text.str();
}

std::string doubt_about(const UprightBox& box) {
  for (const std::string& doubt :
       {doubt_about(box.length, kPlausibleLength, "length"), doubt_about(box.width, kPlausibleWidth, "width"),
        doubt_about(box.height, kPlausibleHeight, "height")}) {
    if (!doubt.empty()) return doubt;
  }
  return "";
}

}  // namespace

std::vector<Vehicle> find_vehicles(const VoxelLevel& level) {
  const std::vector<std::int32_t>& labels = level.channels().labels;
  if (labels.size() != level.size()) throw std::invalid_argument("a level without labels has no vehicles");
  std::vector<std::uint8_t> is_vehicle(level.size());
  std::ranges::transform(labels, is_vehicle.begin(), [](std::int32_t label) {
    return surface_class_of(label) == SurfaceClass::kVehicle ? std::uint8_t{1} : std::uint8_t{0};
  });
  std::vector<Eigen::Vector3d> means(level.size());
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    if (is_vehicle[number] != 0) means[number] = mean_of(level.records()[number], voxel, level.voxel_size());
  });

  std::vector<Cluster> clusters;
  const auto reach = static_cast<std::int32_t>(std::lround(kGroupReach / level.voxel_size()));
  for (VoxelGroup& group : find_groups(level, is_vehicle, reach)) {
    Cluster cluster;
    for (const std::size_t number : group) cluster.means.push_back(means[number]);
    cluster.voxels = std::move(group);
    split(std::move(cluster), clusters);
  }

  const GroundFinder ground(level);
  std::vector<Vehicle> vehicles;
  for (const Cluster& cluster : clusters) {
    Vehicle vehicle;
    vehicle.box = smallest_box(cluster.means);
    vehicle.is_completed = complete(vehicle.box, ground);
    vehicle.num_voxels = cluster.voxels.size();
    for (const std::size_t number : cluster.voxels) vehicle.num_points += level.records()[number].count;
    vehicle.doubt = doubt_about(vehicle.box);
    vehicles.push_back(std::move(vehicle));
  }
  return vehicles;
}

}  // namespace vdbmap::parking
