// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/change_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "vdbmap/change/placement.h"
#include "vdbmap/core/map_tiles.h"
#include "vdbmap/core/voxel_assembly.h"

namespace vdbmap {
namespace {

// Says what kinds voxels of the diff's frame are of.
class KindFinder {
 public:
  explicit KindFinder(const MapDiff& diff)
      : appeared_(diff.appeared.level),
        vanished_(diff.vanished.level),
        changed_(diff.changed.level),
        unobserved_(diff.unobserved) {}

  Change find(const VoxelIndex& voxel) const {
    if (appeared_.find(voxel)) return Change::kAppeared;
    if (vanished_.find(voxel)) return Change::kVanished;
    if (changed_.find(voxel)) return Change::kChanged;
    const VoxelLeaf* leaf = unobserved_.find_leaf(voxel);
    const bool is_unobserved = leaf && leaf->getValueMask().isOn(VoxelLeaf::coordToOffset(voxel));
    return is_unobserved ? Change::kUnobserved : Change::kUnchanged;
  }

 private:
  VoxelFinder appeared_;
  VoxelFinder vanished_;
  VoxelFinder changed_;
  const VoxelTree& unobserved_;
};

struct ScenePart {
  VoxelKey key;
  VoxelRecord record;
  Change change;
};

void add_voxels(const VoxelLevel& level, Change change, std::vector<ScenePart>& parts) {
  for_each_voxel(level, [&](const VoxelIndex& voxel, std::size_t number) {
    parts.push_back({key_of_voxel(voxel), level.records()[number], change});
  });
}

void check_of_map(const VoxelMap& map, const MapDiff& diff) {
  if (map.levels.empty()) throw std::invalid_argument("the map has no levels");
  if (std::abs(map.finest().voxel_size() - diff.voxel_size()) >= 1e-9) {
    throw std::invalid_argument("the diff is of maps with other voxels than this one");
  }
  if (map.frame.anchor != diff.frame.anchor) {
    throw std::invalid_argument("the diff is of maps with another anchor than this one: draw the later of the two");
  }
}

}  // namespace

ChangeScene scene_of_changes(const VoxelMap& later, const MapDiff& diff) {
  check_of_map(later, diff);
  const KindFinder kinds(diff);
  std::vector<ScenePart> parts;
  parts.reserve(later.finest().size() + diff.vanished.level.size());
  for_each_voxel(later.finest(), [&](const VoxelIndex& voxel, std::size_t number) {
    parts.push_back({key_of_voxel(voxel), later.finest().records()[number], kinds.find(voxel)});
  });
  add_voxels(diff.vanished.level, Change::kVanished, parts);
  add_voxels(diff.changed.level, Change::kChanged, parts);
  std::ranges::stable_sort(parts, {}, &ScenePart::key);
  const auto first =
      std::unique(parts.begin(), parts.end(), [](const ScenePart& a, const ScenePart& b) { return a.key == b.key; });
  parts.erase(first, parts.end());

  VoxelAssembly assembly(later.finest().voxel_size(), parts.size());
  ChangeScene scene{{later.frame, {}, later.has_color, later.label_scheme}, {}};
  for (const ScenePart& part : parts) {
    [[maybe_unused]] const bool in_order = assembly.add(voxel_of_key(part.key), part.record);
    scene.changes.push_back(part.change);
  }
  scene.map.levels.push_back(assembly.finish());
  return scene;
}

ChangeScene scene_around(const VoxelMap& map, MapSide side, const MapDiff& diff, const Eigen::Vector3d& place,
                         double reach) {
  const double size = map.finest().voxel_size();
  const auto to_voxel = [&](const Eigen::Vector3d& point) {
    return voxel_of_point(point - map.frame.anchor, voxels_per_metre(size));
  };
  openvdb::CoordBBox box = openvdb::CoordBBox::inf();
  const VoxelIndex low = to_voxel(place.array() - reach), high = to_voxel(place.array() + reach);
  for (const int axis : {0, 1}) {
    box.min()[axis] = low[axis];
    box.max()[axis] = high[axis];
  }
  ChangeScene scene{{map.frame, {}, map.has_color, map.label_scheme}, {}};
  scene.map.levels.push_back(cut_leaves(map.finest(), box));
  const Placement in_diff(map.frame, diff.frame, Eigen::Isometry3d::Identity(), size);
  const KindFinder kinds(diff);
  const Change of_the_other = side == MapSide::kEarlier ? Change::kAppeared : Change::kVanished;
  for_each_voxel(scene.map.finest(), [&](const VoxelIndex& voxel, std::size_t) {
    const Change change = kinds.find(voxel + in_diff.shift());
    scene.changes.push_back(change == of_the_other ? Change::kUnchanged : change);
  });
  return scene;
}

}  // namespace vdbmap
