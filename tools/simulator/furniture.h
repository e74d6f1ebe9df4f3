// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tools/simulator/random.h"
#include "tools/simulator/world.h"

namespace vdbmap::simulator {

// Things that stand on a pavement. Each is drawn about the origin of the brush's frame, z up.

/// A street lamp whose arm points along y.
void add_lamp(const Brush& brush, const StandardMaterials& materials);

enum class SignKind { kNoStopping, kParking, kGiveWay, kStreetName };

/// A sign on a post, seen along x.
void add_sign(const Brush& brush, SignKind kind, const StandardMaterials& materials);

void add_bollard(const Brush& brush, const StandardMaterials& materials);

/// A wheeled bin of 120 or 240 litres; the brush's material is its colour.
void add_bin(const Brush& brush, bool is_large);

/// A bicycle, its wheels on the x axis; the brush's material is that of its frame.
void add_bicycle(const Brush& brush, MaterialId tyre);

/// Clothes of a person.
struct Clothes {
  MaterialId skin;
  MaterialId jacket;
  MaterialId trousers;
};

/// A person `height` [m] tall who walks along x; `stride` [rad] is the angle of the legs.
void add_person(const Brush& brush, double height, double stride, const Clothes& clothes);

/// A garden fence from (0,0) to (length,0), of bars that are `bar_distance` [m] apart.
void add_fence(const Brush& brush, double length, double height, double bar_distance);

/// A shed or garage of the size [m], its door at y = 0; the brush's material is that of its walls.
void add_shed(const Brush& brush, const Eigen::Vector3d& size, MaterialId door, MaterialId roof);

}  // namespace vdbmap::simulator
