// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace vdbmap::simulator {

/// What a surface is, in the numbers of SemanticKITTI's .label files.
enum class SurfaceClass : std::uint16_t {
  kOutlier = 1,  ///< no surface: rain, blooming
  kCar = 10,
  kBicycle = 11,
  kBus = 13,
  kMotorcycle = 15,
  kTruck = 18,
  kOtherVehicle = 20,  ///< caravans and trailers
  kPerson = 30,
  kBicyclist = 31,
  kMotorcyclist = 32,
  kRoad = 40,
  kParking = 44,
  kPavement = 48,
  kBuilding = 50,
  kFence = 51,
  kOtherStructure = 52,
  kVegetation = 70,
  kTrunk = 71,
  kTerrain = 72,
  kPole = 80,
  kTrafficSign = 81,
  kOtherObject = 99,
  kMovingCar = 252,
  kMovingBicyclist = 253,
  kMovingPerson = 254,
  kMovingMotorcyclist = 255,
  kMovingBus = 257,
  kMovingTruck = 258,
  kMovingOtherVehicle = 259,
};

/// The class of a thing that moves; the same where SemanticKITTI has none.
SurfaceClass moving_class(SurfaceClass label);

/// The pattern that varies a material's colour from place to place.
enum class Texture { kPlain, kAsphalt, kSlabs, kSetts, kPlaster, kBrick, kRoofTiles, kGrass, kLeaves, kWood };

/// How a surface looks to lasers and cameras.
struct Material {
  SurfaceClass label;
  Eigen::Vector3f color;      ///< sRGB 0..1
  float reflectance = 0.3F;   ///< diffuse, of infrared laser light, 0..1; retroreflectors exceed 1
  float transmission = 0.0F;  ///< share of laser light that passes
  float gloss = 0.0F;         ///< share of the reflectance that leaves as in a mirror
  Texture texture = Texture::kPlain;
};

using MaterialId = std::uint16_t;
using ObjectId = std::uint16_t;

}  // namespace vdbmap::simulator
