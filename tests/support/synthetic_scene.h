// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "vdbmap/core/point_cloud.h"

/// Places made of rectangles, of which every surface is known exactly.
namespace vdbmap::test {

struct Rectangle {
  Eigen::Vector3d corner;  ///< [m]
  Eigen::Vector3d edge_a;  ///< [m] at right angles to edge_b
  Eigen::Vector3d edge_b;  ///< [m]

  Eigen::Vector3d normal() const { return edge_a.cross(edge_b).normalized(); }
};

using Scene = std::vector<Rectangle>;

/// The six sides of a box.
Scene box(const Eigen::Vector3d& min, const Eigen::Vector3d& max);

/// A closed room of 12 m x 8 m x 3 m around the origin with a few pieces of furniture.
Scene room();

/// Floor, ceiling and two walls along x, 80 m long, without anything that tells one place of it from another.
Scene corridor();

/// 60 m of a street along x between two facades with porches, with parked cars, poles and a house across its end.
Scene street();

/// 80 m of a street along x whose houses, bays, cars and poles are all of sizes and places of their own, so that each
/// part of it can be told from every other.
Scene village();

/// Points spread evenly over all surfaces.
PointCloud sample_scene(const Scene& scene, double points_per_square_metre, unsigned seed);

/// A spinning scanner: beams evenly spread in elevation, shots evenly spread in azimuth.
struct Scanner {
  int num_beams = 32;
  int num_azimuths = 900;
  double min_elevation_deg = -25;
  double max_elevation_deg = 15;
  double range_noise = 0;  ///< [m] standard deviation
  unsigned seed = 0;
};

/// What the scanner sees of the scene [m, frame of the scanner]: the first hit of every beam.
PointCloud scan_scene(const Scene& scene, const Eigen::Isometry3d& map_from_scan, const Scanner& scanner = {});

/// What a dense scanner sees of the village from a drive through it [m, frame of the village]: what a map is made of,
/// with the backs of things unseen. Scanned once a program.
const PointCloud& survey_of_village();

/// The cloud moved by a pose.
PointCloud moved(PointCloud cloud, const Eigen::Isometry3d& target_from_cloud);

}  // namespace vdbmap::test
