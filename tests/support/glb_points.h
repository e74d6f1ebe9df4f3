// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>

#include "vdbmap/core/voxel.h"

namespace vdbmap::test {

/// A point of a glTF file as a viewer sees it.
struct GlbPoint {
  Eigen::Vector3d position;  ///< [m] in the file's frame, turned back to z up as viewers of 3D Tiles do
  VoxelIndex voxel;          ///< from the extras
  std::array<int, 3> color{-1, -1, -1};
  std::array<int, 4> attributes{};  ///< _VOXEL: label code, change, faces, age
  double voxel_size = 0;            ///< [m] from the extras
  std::size_t detail = 0;           ///< number in the file of details
};

/// The JSON of a binary glTF file. Throws std::runtime_error where the container is not as glTF 2.0 says.
nlohmann::json json_of_glb(const std::string& glb);

/// Decodes the points of a binary glTF file by what its JSON says: scene, nodes with their transforms, accessors, views
/// compressed by EXT_meshopt_compression.
std::vector<GlbPoint> points_of_glb(const std::string& glb);

}  // namespace vdbmap::test
