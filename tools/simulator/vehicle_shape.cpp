// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/vehicle_shape.h"

#include <algorithm>
#include <array>

namespace vdbmap::simulator {
namespace {

// Means and spread of new cars' papers; shares about as the German register (KBA 2023) has the segments.
struct BodyStatistics {
  double share;
  double length, length_spread;  // [m]
  double width;                  // [m]
  double height, height_spread;  // [m]
  double wheelbase;              // share of the length
  double wheel_radius;           // [m]
};

const std::array<BodyStatistics, 6> kStatistics = {{
    {0.36, 4.10, 0.18, 1.77, 1.48, 0.03, 0.622, 0.315},  // hatchback
    {0.12, 4.72, 0.14, 1.83, 1.45, 0.02, 0.605, 0.325},  // saloon
    {0.17, 4.68, 0.13, 1.82, 1.48, 0.03, 0.603, 0.325},  // estate
    {0.20, 4.48, 0.18, 1.84, 1.65, 0.05, 0.600, 0.350},  // SUV
    {0.12, 5.15, 0.35, 1.95, 2.05, 0.18, 0.600, 0.340},  // van
    {0.03, 5.33, 0.06, 1.87, 1.81, 0.03, 0.600, 0.375},  // pickup
}};

std::vector<BodyStation> low_stations(double hood, double belt, double tail) {
  return {{0.000, 0.80, hood - 0.10, 0.30}, {0.025, 0.93, hood - 0.04, 0.22}, {0.100, 0.985, hood, 0.19},
          {0.260, 1.00, belt - 0.02, 0.18}, {0.600, 1.00, belt, 0.18},        {0.900, 0.985, tail, 0.20},
          {0.975, 0.93, tail - 0.01, 0.26}, {1.000, 0.84, tail - 0.07, 0.32}};
}

const std::array<BodyStyle, 6>& styles() {
  static const std::array<BodyStyle, 6> kStyles = {{
      {low_stations(.58, .64, .66), .25, .43, .86, .965, .965, .76, {{.05, .40}, {.45, .76}, {.81, .94}}, true},
      {low_stations(.58, .65, .68), .28, .45, .72, .860, .860, .74, {{.05, .45}, {.50, .90}}, true},
      {low_stations(.58, .65, .67), .27, .43, .90, .975, .975, .76, {{.05, .36}, {.41, .68}, {.73, .94}}, true},
      {low_stations(.60, .65, .66), .26, .41, .89, .970, .970, .78, {{.05, .38}, {.43, .72}, {.77, .93}}, true},
      {{{.000, .82, .38, .30},
        {.020, .93, .46, .24},
        {.100, .99, .54, .22},
        {.250, 1.0, .56, .22},
        {.970, .99, .56, .24},
        {1.00, .95, .55, .30}},
       .10,
       .23,
       .985,
       .997,
       .980,
       .88,
       {{.03, .24}},
       false},
      {low_stations(.58, .60, .60), .27, .38, .60, .640, .960, .78, {{.05, .48}, {.54, .92}}, true},
  }};
  return kStyles;
}

// Bodies from kBoxVan on.
struct LargeStatistics {
  double shortest, longest;  // [m]
  double width;              // [m]
  double lowest, highest;    // [m]
  double wheelbase;          // share of the length
  double wheel_radius;       // [m]
};

constexpr std::array<LargeStatistics, 6> kLargeStatistics = {{
    {5.0, 6.8, 2.05, 2.5, 3.1, 0.58, 0.35},   // box van
    {6.5, 9.5, 2.45, 3.1, 3.9, 0.55, 0.48},   // truck
    {9.5, 12.2, 2.50, 2.9, 3.2, 0.50, 0.48},  // bus
    {4.6, 6.3, 2.20, 2.4, 2.7, 0.40, 0.33},   // caravan
    {2.2, 3.8, 1.60, 0.9, 2.0, 0.40, 0.30},   // trailer
    {1.9, 2.3, 0.80, 1.05, 1.25, 0.66, 0.30}  // motorcycle
}};

VehicleBody choose_body(Random& random) {
  double choice = random.uniform(0, 1);
  for (std::size_t i = 0; i < kStatistics.size(); ++i) {
    choice -= kStatistics[i].share;
    if (choice < 0) return static_cast<VehicleBody>(i);
  }
  return VehicleBody::kHatchback;
}

// Within two deviations: no car is a giant.
double spread(double mean, double deviation, Random& random) {
  return mean + deviation * std::clamp(random.normal(0, 1), -2.0, 2.0);
}

}  // namespace

std::string name_of(VehicleBody body) {
  constexpr std::array<const char*, 12> kNames = {"hatchback", "saloon", "estate", "suv",     "van",     "pickup",
                                                  "box van",   "truck",  "bus",    "caravan", "trailer", "motorcycle"};
  return kNames[static_cast<std::size_t>(body)];
}

SurfaceClass class_of(VehicleBody body) {
  switch (body) {
    case VehicleBody::kBoxVan:
    case VehicleBody::kTruck:
      return SurfaceClass::kTruck;
    case VehicleBody::kBus:
      return SurfaceClass::kBus;
    case VehicleBody::kCaravan:
    case VehicleBody::kTrailer:
      return SurfaceClass::kOtherVehicle;
    case VehicleBody::kMotorcycle:
      return SurfaceClass::kMotorcycle;
    default:
      return SurfaceClass::kCar;
  }
}

const BodyStyle& style_of(VehicleBody body) { return styles()[static_cast<std::size_t>(body)]; }

VehicleShape make_vehicle_shape(double longest, Random& random) {
  for (;;) {
    const VehicleBody body = choose_body(random);
    const BodyStatistics& statistics = kStatistics[static_cast<std::size_t>(body)];
    const double length = spread(statistics.length, statistics.length_spread, random);
    if (length > longest) continue;
    return {body,
            length,
            spread(statistics.width, 0.03, random),
            spread(statistics.height, statistics.height_spread, random),
            length * statistics.wheelbase,
            statistics.wheel_radius};
  }
}

VehicleShape make_large_shape(VehicleBody body, double longest, Random& random) {
  const auto index = static_cast<std::size_t>(body) - static_cast<std::size_t>(VehicleBody::kBoxVan);
  const LargeStatistics& statistics = kLargeStatistics.at(index);
  const double upper = std::max(statistics.shortest, std::min(statistics.longest, longest));
  const double length = random.uniform(statistics.shortest, upper);
  return {body,
          length,
          spread(statistics.width, 0.02 * statistics.width, random),
          random.uniform(statistics.lowest, statistics.highest),
          length * statistics.wheelbase,
          statistics.wheel_radius};
}

VehicleShape make_any_shape(double longest, Random& random) {
  const double choice = random.uniform(0, 1);
  if (longest > 7 && choice < 0.3) return make_large_shape(VehicleBody::kTruck, longest, random);
  if (longest > 5 && choice < 0.04) return make_large_shape(VehicleBody::kBoxVan, longest, random);
  if (longest > 5 && choice < 0.06) return make_large_shape(VehicleBody::kCaravan, longest, random);
  if (choice < 0.09) return make_large_shape(VehicleBody::kTrailer, longest, random);
  if (choice < 0.12) return make_large_shape(VehicleBody::kMotorcycle, longest, random);
  return make_vehicle_shape(longest, random);
}

}  // namespace vdbmap::simulator
