// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/things/kinds.h"

#include <array>

#include "tools/simulator/things/garden_things.h"
#include "tools/simulator/things/people.h"
#include "tools/simulator/things/plants.h"
#include "tools/simulator/things/street_things.h"

namespace vdbmap::simulator {

std::span<const ThingKind> thing_kinds() {
  using enum SurfaceClass;
  using enum Zone;
  using enum Stay;
  using enum Season;
  static constexpr auto kKinds = std::to_array<ThingKind>({
      // Plants
      {"hedge", kVegetation, kInGarden, kYears, 2.5, 5.0, 1.2, draw_clipped_hedge},
      {"bushes", kVegetation, kInGarden, kYears, 7.0, 2.5, 2.0, draw_wild_bushes, kSheds},
      {"kerb bushes", kVegetation, kAtKerb, kYears, 1.2, 2.2, 1.3, draw_wild_bushes, kSheds},
      {"clipped shrub", kVegetation, kAtKerb, kYears, 0.8, 4.6, 1.4, draw_car_sized_shrub},
      {"bed", kVegetation, kAtKerb, kYears, 0.6, 2.6, 1.0, draw_bed, kSheds},
      {"planting", kVegetation, kAtKerb, kYears, 1.6, 3.6, 1.4, draw_planting, kSheds},
      {"ground cover", kVegetation, kInGarden, kYears, 3.0, 4.0, 1.8, draw_planting, kSheds},
      {"low hedge", kVegetation, kInGarden, kYears, 3.0, 5.0, 0.7, draw_low_hedge},
      {"walled hedge", kVegetation, kInGarden, kYears, 1.5, 6.0, 0.8, draw_walled_hedge},
      {"bank", kTerrain, kInGarden, kYears, 1.2, 7.0, 2.4, draw_bank},
      {"boulders", kOtherObject, kInGarden, kYears, 0.6, 2.5, 1.0, draw_boulders},
      {"ivy", kVegetation, kAtWall, kYears, 1.0, 3.0, 0.3, draw_ivy},
      {"tree pit", kTerrain, kAtKerb, kYears, 0.8, 2.0, 1.4, draw_tree_pit, kSheds},
      {"trunk", kTrunk, kAtKerb, kYears, 0.5, 1.5, 1.0, draw_thick_trunk},
      {"conifer", kVegetation, kInGarden, kYears, 1.2, 2.5, 2.5, draw_conifer},
      {"tall grass", kVegetation, kInGarden, kYears, 2.0, 3.0, 1.0, draw_tall_grass},
      // What the city puts up
      {"wide sign", kTrafficSign, kAtKerb, kYears, 0.4, 1.0, 0.6, draw_wide_sign},
      {"cabinet", kOtherObject, kAtGardens, kYears, 0.6, 1.8, 0.5, draw_cabinet},
      {"bench", kOtherObject, kAtGardens, kYears, 0.3, 2.2, 0.6, draw_bench},
      {"bus shelter", kOtherStructure, kAtGardens, kYears, 0.15, 4.5, 1.5, draw_bus_shelter},
      // Of one day
      {"skip", kOtherObject, kOnSpace, kDay, 0.35, 4.4, 2.0, draw_skip},
      {"market stall", kOtherStructure, kOnSpace, kDay, 0.25, 3.0, 2.4, draw_market_stall},
      {"parklet", kOtherObject, kOnSpace, kDay, 0.15, 5.0, 2.0, draw_cafe},
      {"scaffolding", kOtherStructure, kAtWall, kDay, 0.25, 7.5, 1.3, draw_scaffolding},
      {"cafe", kOtherObject, kAtGardens, kDay, 0.4, 5.0, 1.3, draw_cafe},
      {"pallets", kOtherObject, kAtKerb, kDay, 0.4, 3.0, 1.0, draw_pallets},
      {"construction fence", kFence, kAtKerb, kDay, 0.35, 10.5, 0.6, draw_construction_fence},
      {"bins", kOtherObject, kAtKerb, kDay, 1.5, 2.5, 0.8, draw_bin_row},
      {"snow heap", kOtherObject, kAtKerb, kDay, 3.0, 3.0, 1.0, draw_snow_heap, kWinter},
      {"bicycles", kBicycle, kAtGardens, kDay, 0.8, 2.5, 0.8, draw_parked_bicycles},
      // Who stands still while the scanner passes
      {"person", kPerson, kAtGardens, kDay, 0.8, 0.8, 0.8, draw_person},
      {"group", kPerson, kAtGardens, kDay, 0.6, 2.2, 1.2, draw_group},
      {"wheelchair", kPerson, kAtGardens, kDay, 0.12, 2.0, 0.8, draw_wheelchair},
      {"pram", kOtherObject, kAtGardens, kDay, 0.15, 2.0, 0.8, draw_pram},
      {"dog", kOtherObject, kAtGardens, kDay, 0.15, 2.0, 0.8, draw_dog},
      {"waiting cyclist", kBicyclist, kAtKerb, kDay, 0.15, 2.0, 0.8, draw_cyclist},
  });
  return kKinds;
}

}  // namespace vdbmap::simulator
