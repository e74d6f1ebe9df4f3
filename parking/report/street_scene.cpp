// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/report/street_scene.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "parking/segmentation/surface_class.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap::parking {
namespace {

constexpr double kHighest = 3;                          // [m] above the ground
constexpr double kGroundReaches[] = {1.5, 4, 12};       // [m] at which ground is looked for where there is none
constexpr double kAroundSpace = 0.6;                    // [m]
const Eigen::Vector3d kVehicleColor(0.10, 0.16, 0.26);  // linear
const Eigen::Vector3d kNewGroundColor(0.22, 0.22, 0.22);

struct KeyedVoxel {
  VoxelKey key;
  VoxelRecord record;
};

Eigen::Vector3d class_color(SurfaceClass surface) {
  switch (surface) {
    case SurfaceClass::kGround:
      return Eigen::Vector3d::Constant(0.3);
    case SurfaceClass::kBuilding:
      return {0.45, 0.36, 0.30};
    case SurfaceClass::kVegetation:
      return {0.12, 0.25, 0.08};
    case SurfaceClass::kVehicle:
      return kVehicleColor;
    default:
      return {0.35, 0.30, 0.20};
  }
}

const std::vector<std::int32_t>& checked_labels(const VoxelLevel& level) {
  if (level.channels().labels.size() != level.size()) throw std::invalid_argument("a scene is made of labelled maps");
  return level.channels().labels;
}

bool is_low(const GroundPlan& ground, const Eigen::Vector3d& place) {
  std::optional<double> height = ground.height_at(place.head<2>());
  for (const double reach : kGroundReaches) {
    if (!height) height = ground.height_near(place.head<2>(), reach);
  }
  return height && place.z() < *height + kHighest;
}

void add_standing(const VoxelMap& map, const GroundPlan& ground, std::vector<KeyedVoxel>& voxels) {
  const VoxelLevel& level = map.finest();
  const std::vector<std::int32_t>& labels = checked_labels(level);
  std::vector<std::uint8_t> is_kept(level.size());
  parallel_for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const std::optional<SurfaceClass> surface = surface_class_of(labels[number]);
    is_kept[number] =
        surface && *surface != SurfaceClass::kVehicle && is_low(ground, center_of_voxel(voxel, level.voxel_size()));
  });
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    if (is_kept[number] == 0) return;
    voxels.push_back({key_of_voxel(voxel), level.records()[number]});
    if (!map.has_color) set_color(voxels.back().record, class_color(*surface_class_of(labels[number])));
  });
}

// Tells places in or close to spaces: cars that passed by left trails elsewhere.
class SpacePlaces {
 public:
  explicit SpacePlaces(std::span<const ParkingSpace> spaces) {
    for (const ParkingSpace& space : spaces) {
      boxes_.push_back(box_of(space));
      boxes_.back().length += 2 * kAroundSpace;
      boxes_.back().width += kAroundSpace;
    }
  }

  bool contains(const Eigen::Vector3d& place) const {
    return std::ranges::any_of(boxes_, [&](const UprightBox& box) { return box.contains(place.head<2>()); });
  }

 private:
  std::vector<UprightBox> boxes_;
};

void add_later(const VoxelMap& later, const GroundPlan& ground, const SpacePlaces& spaces,
               std::vector<KeyedVoxel>& voxels) {
  const VoxelLevel& level = later.finest();
  const std::vector<std::int32_t>& labels = checked_labels(level);
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    const std::optional<SurfaceClass> surface = surface_class_of(labels[number]);
    const Eigen::Vector3d center = center_of_voxel(voxel, level.voxel_size());
    const bool is_vehicle = surface == SurfaceClass::kVehicle && spaces.contains(center) && is_low(ground, center);
    const bool is_new_ground = surface == SurfaceClass::kGround && !ground.height_at(center.head<2>());
    if (!is_vehicle && !is_new_ground) return;
    voxels.push_back({key_of_voxel(voxel), level.records()[number]});
    if (!later.has_color) set_color(voxels.back().record, is_vehicle ? kVehicleColor : kNewGroundColor);
  });
}

}  // namespace

VoxelMap street_scene(const VoxelMap& map, const VoxelMap& later, const GroundPlan& ground,
                      std::span<const ParkingSpace> spaces) {
  std::vector<KeyedVoxel> voxels;
  add_standing(map, ground, voxels);
  const bool has_later =
      !later.levels.empty() && later.finest().size() > 0 && later.finest().voxel_size() == map.finest().voxel_size();
  if (has_later) add_later(later, ground, SpacePlaces(spaces), voxels);
  std::ranges::stable_sort(voxels, {}, &KeyedVoxel::key);
  VoxelAssembly assembly(map.finest().voxel_size(), voxels.size());
  std::optional<VoxelKey> last;
  for (const KeyedVoxel& voxel : voxels) {
    if (voxel.key == last) continue;  // of two in one place the map's own stays
    last = voxel.key;
    [[maybe_unused]] const bool in_order = assembly.add(voxel_of_key(voxel.key), voxel.record);
  }
  VoxelMap scene{map.frame, {}, true, LabelScheme::kUnknown};
  scene.levels.push_back(assembly.finish());
  return scene;
}

}  // namespace vdbmap::parking
