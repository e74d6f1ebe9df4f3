// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/label_names.h"

namespace vdbmap::simulator {

const std::vector<std::pair<SurfaceClass, std::string_view>>& label_names() {
  using enum SurfaceClass;
  static const std::vector<std::pair<SurfaceClass, std::string_view>> kNames = {
      {kCar, "car"},
      {kBicycle, "bicycle"},
      {kPerson, "person"},
      {kRoad, "road"},
      {kParking, "parking"},
      {kPavement, "sidewalk"},
      {kBuilding, "building"},
      {kFence, "fence"},
      {kVegetation, "vegetation"},
      {kTrunk, "trunk"},
      {kTerrain, "terrain"},
      {kPole, "pole"},
      {kTrafficSign, "traffic-sign"},
      {kOtherObject, "other-object"},
  };
  return kNames;
}

}  // namespace vdbmap::simulator
