// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/changes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "vdbmap/core/voxel_id.h"
#include "vdbmap/core/voxel_map.h"

namespace vdbmap::simulator {
namespace {

constexpr double kSampleDistance = 0.02;  // [m]
constexpr std::int32_t kBlockSize = 16;   // voxels along a block; triangles far from changes are passed over by blocks

// From the scene to the grid.
struct Grid {
  Eigen::Vector3d shift;  // anchor -> scene's origin [m]

  VoxelIndex voxel(const Eigen::Vector3f& point) const {
    return voxel_of_point(shift + point.cast<double>(), 1 / kChangeVoxelSize);
  }
};

VoxelId block_of(const VoxelIndex& voxel) { return id_of_voxel(parent_of_voxel(voxel, kBlockSize)); }

struct Corners3 {
  Eigen::Vector3f a, b, c;
};

Corners3 corners(const Mesh& mesh, const Triangle& triangle) {
  return {mesh.vertices[triangle.a], mesh.vertices[triangle.b], mesh.vertices[triangle.c]};
}

// Calls visit(point) for points that cover the triangle.
template <typename Visit>
void sample(const Corners3& t, const Visit& visit) {
  const float longest = std::max({(t.b - t.a).norm(), (t.c - t.a).norm(), (t.c - t.b).norm()});
  const int count = std::max(1, static_cast<int>(std::ceil(longest / kSampleDistance)));
  for (int i = 0; i <= count; ++i) {
    for (int k = 0; k <= count - i; ++k) {
      const float u = static_cast<float>(i) / static_cast<float>(count);
      const float v = static_cast<float>(k) / static_cast<float>(count);
      visit(Eigen::Vector3f(t.a + u * (t.b - t.a) + v * (t.c - t.a)));
    }
  }
}

using Occupied = std::unordered_map<VoxelId, ChangedVoxel>;

Occupied occupied_voxels(const Mesh& mesh, const Grid& grid, const World& world, bool has_appeared) {
  Occupied occupied;
  for (const Triangle& triangle : mesh.triangles) {
    const auto label = static_cast<std::uint16_t>(world.materials()[triangle.material].label);
    sample(corners(mesh, triangle), [&](const Eigen::Vector3f& point) {
      const VoxelIndex voxel = grid.voxel(point);
      occupied.try_emplace(id_of_voxel(voxel), ChangedVoxel{voxel, has_appeared, label, triangle.object});
    });
  }
  return occupied;
}

// Whether a block around the triangle is among `blocks`.
bool is_near(const Corners3& t, const Grid& grid, const std::unordered_set<VoxelId>& blocks) {
  const VoxelIndex low = parent_of_voxel(grid.voxel(t.a.cwiseMin(t.b).cwiseMin(t.c)), kBlockSize);
  const VoxelIndex high = parent_of_voxel(grid.voxel(t.a.cwiseMax(t.b).cwiseMax(t.c)), kBlockSize);
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) {
        if (blocks.contains(id_of_voxel({x, y, z}))) return true;
      }
    }
  }
  return false;
}

void remove_lasting(Occupied& changed, const Mesh& lasting, const Grid& grid) {
  std::unordered_set<VoxelId> blocks;
  for (const auto& [id, voxel] : changed) blocks.insert(block_of(voxel.voxel));
  for (const Triangle& triangle : lasting.triangles) {
    const Corners3 t = corners(lasting, triangle);
    if (!is_near(t, grid, blocks)) continue;
    sample(t, [&](const Eigen::Vector3f& point) { changed.erase(id_of_voxel(grid.voxel(point))); });
  }
}

}  // namespace

Eigen::Vector3d change_anchor(const Street& street) { return choose_anchor(street.origin()); }

std::vector<ChangedVoxel> changed_voxels(const Street& street, int epoch) {
  const Grid grid = {street.origin() - change_anchor(street)};
  const auto index = static_cast<std::size_t>(epoch);
  const Occupied before = occupied_voxels(street.changing.at(index), grid, street.world, false);
  Occupied changed = occupied_voxels(street.changing.at(index + 1), grid, street.world, true);
  for (const auto& [id, voxel] : before) {
    if (changed.erase(id) == 0) changed.emplace(id, voxel);
  }
  remove_lasting(changed, street.lasting, grid);

  std::vector<ChangedVoxel> result;
  for (const auto& [id, voxel] : changed) result.push_back(voxel);
  std::ranges::sort(result, {}, [](const ChangedVoxel& v) { return id_of_voxel(v.voxel); });
  return result;
}

}  // namespace vdbmap::simulator
