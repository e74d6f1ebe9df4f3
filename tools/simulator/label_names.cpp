// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/label_names.h"

#include "vdbmap/core/label_scheme.h"

namespace vdbmap::simulator {

std::vector<std::pair<SurfaceClass, std::string>> label_names() {
  using enum SurfaceClass;
  std::vector<std::pair<SurfaceClass, std::string>> names;
  for (const SurfaceClass label : {kCar, kBicycle, kPerson, kRoad, kParking, kPavement, kBuilding, kFence, kVegetation,
                                   kTrunk, kTerrain, kPole, kTrafficSign, kOtherObject}) {
    names.emplace_back(label, label_name(LabelScheme::kSemanticKitti, static_cast<int>(label)));
  }
  return names;
}

}  // namespace vdbmap::simulator
