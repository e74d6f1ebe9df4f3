// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/material.h"

namespace vdbmap::simulator {

SurfaceClass moving_class(SurfaceClass label) {
  using enum SurfaceClass;
  switch (label) {
    case kCar:
      return kMovingCar;
    case kBicyclist:
      return kMovingBicyclist;
    case kPerson:
      return kMovingPerson;
    case kMotorcyclist:
      return kMovingMotorcyclist;
    case kBus:
      return kMovingBus;
    case kTruck:
      return kMovingTruck;
    case kOtherVehicle:
      return kMovingOtherVehicle;
    default:
      return label;
  }
}

}  // namespace vdbmap::simulator
