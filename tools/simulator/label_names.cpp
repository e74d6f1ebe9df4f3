// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/label_names.h"

#include "vdbmap/core/label_scheme.h"

namespace vdbmap::simulator {

namespace {

using enum SurfaceClass;

const std::vector<SurfaceClass> kIdealClasses = {kCar,      kBicycle,  kPerson,      kRoad,       kParking,
                                                 kPavement, kBuilding, kFence,       kVegetation, kTrunk,
                                                 kTerrain,  kPole,     kTrafficSign, kOtherObject};

const std::vector<SurfaceClass> kClasses = {kOutlier,
                                            kCar,
                                            kBicycle,
                                            kBus,
                                            kMotorcycle,
                                            kTruck,
                                            kOtherVehicle,
                                            kPerson,
                                            kBicyclist,
                                            kMotorcyclist,
                                            kRoad,
                                            kParking,
                                            kPavement,
                                            kBuilding,
                                            kFence,
                                            kOtherStructure,
                                            kVegetation,
                                            kTrunk,
                                            kTerrain,
                                            kPole,
                                            kTrafficSign,
                                            kOtherObject,
                                            kMovingCar,
                                            kMovingBicyclist,
                                            kMovingPerson,
                                            kMovingMotorcyclist,
                                            kMovingBus,
                                            kMovingTruck,
                                            kMovingOtherVehicle};

}  // namespace

std::vector<std::pair<SurfaceClass, std::string>> label_names(bool is_ideal) {
  std::vector<std::pair<SurfaceClass, std::string>> names;
  for (const SurfaceClass label : is_ideal ? kIdealClasses : kClasses) {
    names.emplace_back(label, label_name(LabelScheme::kSemanticKitti, static_cast<int>(label)));
  }
  return names;
}

}  // namespace vdbmap::simulator
