// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/simulator/material.h"
#include "tools/simulator/random.h"

namespace vdbmap::simulator {

enum class VehicleBody {
  kHatchback,
  kSaloon,
  kEstate,
  kSuv,
  kVan,
  kPickup,
  // Not drawn from stations (things/large_vehicles.h):
  kBoxVan,
  kTruck,
  kBus,
  kCaravan,
  kTrailer,
  kMotorcycle,
};

/// "hatchback", "saloon", "estate", "suv", "van", "pickup", "box van", "truck", "bus", "caravan", "trailer",
/// "motorcycle".
std::string name_of(VehicleBody body);

/// What SemanticKITTI counts it as: a car has one continuous body, pickups included as of old.
SurfaceClass class_of(VehicleBody body);

/// A cross-section of the lower body; shares of length, half width and height.
struct BodyStation {
  double from_front;
  double half_width;
  double top;
  double bottom;  ///< [m] above ground
};

/// Where the parts of a body begin and end; shares of the length from the front.
struct BodyStyle {
  std::vector<BodyStation> stations;  ///< from front to rear
  double windscreen_foot;
  double roof_front;
  double roof_rear;
  double rear_window_foot;
  double open_end;                                      ///< of what has no lid: the cabin, or a pickup's bed
  double roof_half_width;                               ///< share of the half width
  std::vector<std::pair<double, double>> side_windows;  ///< shares of the cabin's side, from the front
  bool has_rear_window;
};

/// Of the first six bodies.
const BodyStyle& style_of(VehicleBody body);

/// What a car of some make measures [m]; width without mirrors, as in its papers.
struct VehicleShape {
  VehicleBody body;
  double length;
  double width;
  double height;
  double wheelbase;
  double wheel_radius;

  double track() const { return width - 0.25; }
};

/// A car as German streets have them, no longer than `longest` [m].
VehicleShape make_vehicle_shape(double longest, Random& random);

/// A vehicle of a body other than the first six, no longer than `longest` [m] where there are such.
VehicleShape make_large_shape(VehicleBody body, double longest, Random& random);

/// A car or, one time in eight, a box van, caravan, trailer or motorcycle; where there is room for 7 m, a truck.
VehicleShape make_any_shape(double longest, Random& random);

}  // namespace vdbmap::simulator
