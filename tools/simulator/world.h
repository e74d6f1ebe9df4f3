// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/material.h"
#include "tools/simulator/mesh.h"
#include "tools/simulator/random.h"

namespace vdbmap::simulator {

/// A thing that labels can name.
struct SceneObject {
  std::string kind;          ///< "house", "tree", "hatchback", ...
  Eigen::Vector3d position;  ///< [m, scene frame] of its foot
  int epoch = -1;            ///< the one in which it is there, or -1 for every one; vehicles have a list of their own
  bool moves = false;        ///< while it is scanned; then `position` is where it is first
};

/// Materials that many things share.
struct StandardMaterials {
  MaterialId asphalt, parking, kerb, slabs, setts, grass, soil;
  MaterialId window_glass, window_frame, interior, curtain, door, stone, railing, roof_tiles, dark_roof, gutter;
  MaterialId wood, metal_fence, brick_wall, hedge, leaves, bark;
  MaterialId steel, lamp, sign_white, sign_blue, sign_red, bollard;
  MaterialId car_glass, tyre, rim, car_interior, car_trim, headlight, tail_light, plate;
  MaterialId twigs, snow, plaster;
};

/// What a vehicle of one class is made of, but for its paint.
struct VehicleMaterials {
  MaterialId glass, tyre, rim, interior, trim, headlight, tail_light, plate;
};

/// The materials and objects of all epochs; the number of each is its index.
class World {
 public:
  World();

  MaterialId add_material(const Material& material);

  /// A brush that draws a new object into `mesh`, in the object's own frame.
  Brush add_object(Mesh& mesh, SceneObject object, const Eigen::Isometry3d& scene_from_object, MaterialId material);

  /// A number for an object that is drawn later, and perhaps in several epochs.
  ObjectId add_object(SceneObject object);

  /// Paint of a vehicle's class, of the colours that cars have; one in eight is nearly black to a laser.
  MaterialId add_paint(SurfaceClass label, Random& random);

  const StandardMaterials& standard() const { return standard_; }
  /// The materials of a class of vehicles; a car's for any other class.
  const VehicleMaterials& vehicle(SurfaceClass label) const;
  const std::vector<Material>& materials() const { return materials_; }
  const std::vector<SceneObject>& objects() const { return objects_; }

 private:
  std::vector<Material> materials_;
  std::vector<SceneObject> objects_;
  StandardMaterials standard_;
  std::map<SurfaceClass, VehicleMaterials> vehicles_;
};

}  // namespace vdbmap::simulator
