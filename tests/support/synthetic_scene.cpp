// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/synthetic_scene.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace vdbmap::test {
namespace {

void append(Scene& scene, const Scene& part) { scene.insert(scene.end(), part.begin(), part.end()); }

// Distance along the ray to the rectangle; infinity where it misses.
double distance_to(const Rectangle& rectangle, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d normal = rectangle.edge_a.cross(rectangle.edge_b);
  const double distance = normal.dot(rectangle.corner - origin) / normal.dot(direction);
  if (!(distance > 1e-3) || !std::isfinite(distance)) return kMiss;

  const Eigen::Vector3d from_corner = origin + distance * direction - rectangle.corner;
  const double a = from_corner.dot(rectangle.edge_a) / rectangle.edge_a.squaredNorm();
  const double b = from_corner.dot(rectangle.edge_b) / rectangle.edge_b.squaredNorm();
  return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? distance : kMiss;
}

double first_hit(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Rectangle& rectangle : scene) nearest = std::min(nearest, distance_to(rectangle, origin, direction));
  return nearest;
}

}  // namespace

Scene box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  const Eigen::Vector3d size = max - min;
  const Eigen::Vector3d x(size.x(), 0, 0);
  const Eigen::Vector3d y(0, size.y(), 0);
  const Eigen::Vector3d z(0, 0, size.z());
  return {{min, x, y}, {min, y, z}, {min, z, x}, {max, -y, -x}, {max, -z, -y}, {max, -x, -z}};
}

Scene room() {
  Scene scene = box({-6, -4, 0}, {6, 4, 3});
  append(scene, box({-5.5, 1.2, 0}, {-4.1, 3.4, 0.8}));
  append(scene, box({2.3, -3.9, 0}, {3.2, -3.1, 2.1}));
  append(scene, box({4.4, 0.7, 0.6}, {5.7, 2.5, 0.75}));
  return scene;
}

Scene corridor() {
  Scene scene = box({-40, -2, 0}, {40, 2, 3});
  std::erase_if(scene, [](const Rectangle& side) { return std::abs(side.normal().x()) > 0.5; });
  return scene;
}

Scene street() {
  Scene scene = {{{-30, -9, 0}, {60, 0, 0}, {0, 18, 0}},  // ground
                 {{-30, -9, 0}, {60, 0, 0}, {0, 0, 9}},   // facades
                 {{-30, 9, 0}, {60, 0, 0}, {0, 0, 7}},    //
                 {{30, -9, 0}, {0, 18, 0}, {0, 0, 10}}};  // the house across the end
  for (const double x : {-24.0, -9.5, 4.0, 17.3}) append(scene, box({x, -9, 0}, {x + 3, -7.8, 2.6}));  // porches
  for (const double x : {-18.2, -2.0, 11.7, 22.4}) append(scene, box({x, 7.9, 0}, {x + 2.2, 9, 3.1}));
  for (const double x : {-26.0, -19.5, -12.0, -5.4, 1.8, 13.6}) append(scene, box({x, -6, 0}, {x + 4.3, -4.2, 1.5}));
  for (const double x : {-22.0, -7.7, 5.1, 16.0}) append(scene, box({x, 4.3, 0}, {x + 4.4, 6.1, 1.45}));
  for (const double x : {-15.0, 0.0, 15.0}) append(scene, box({x, 6.9, 0}, {x + 0.25, 7.15, 6}));  // poles
  return scene;
}

Scene village() {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  Scene scene = {{{-40, -14, 0}, {80, 0, 0}, {0, 28, 0}}};  // ground
  for (const double side : {-1.0, 1.0}) {
    for (double x = -40; x < 34;) {
      const double width = between(5, 10);
      const double front = between(6, 9.5);  // distance of the facade from the middle of the street
      const double near = side > 0 ? front : -13;
      const double far = side > 0 ? 13 : -front;
      append(scene, box({x, near, 0}, {x + width, far, between(3, 9)}));
      const double bay = x + between(0.5, width - 2.5);
      const double depth = between(0.4, 1.3);
      append(scene, box({bay, side > 0 ? front - depth : -front, 0},
                        {bay + 1.8, side > 0 ? front : -front + depth, between(2, 4)}));
      x += width + between(0.5, 4);
    }
    for (double x = -38; x < 36; x += between(5, 11)) {
      Eigen::Isometry3d parked(Eigen::Translation3d(x, side * between(3.6, 4.6), 0));
      parked.rotate(Eigen::AngleAxisd(between(-0.4, 0.4), Eigen::Vector3d::UnitZ()));
      // One after the other: in what order arguments are made, each compiler decides.
      const double front = between(1.8, 2.5);
      const double height = between(1.3, 2.2);
      const double back = between(1.8, 2.5);
      for (const Rectangle& r : box({-back, -0.9, 0}, {front, 0.9, height})) {
        scene.push_back({parked * r.corner, parked.linear() * r.edge_a, parked.linear() * r.edge_b});
      }
    }
  }
  for (int i = 0; i < 9; ++i) {
    const double x = between(-38, 38);
    const double y = between(4.8, 5.8) * (i % 2 == 0 ? 1 : -1);
    append(scene, box({x, y, 0}, {x + 0.2, y + 0.2, between(3, 7)}));
  }
  return scene;
}

PointCloud sample_scene(const Scene& scene, double points_per_square_metre, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  PointCloud cloud;
  for (const Rectangle& rectangle : scene) {
    const double area = rectangle.edge_a.norm() * rectangle.edge_b.norm();
    const auto count = static_cast<std::size_t>(area * points_per_square_metre);
    for (std::size_t i = 0; i < count; ++i) {
      const double a = share(random);
      const double b = share(random);
      cloud.positions.emplace_back(rectangle.corner + a * rectangle.edge_a + b * rectangle.edge_b);
    }
  }
  return cloud;
}

PointCloud scan_scene(const Scene& scene, const Eigen::Isometry3d& map_from_scan, const Scanner& scanner) {
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  std::mt19937 random(scanner.seed);
  std::normal_distribution<double> normal;
  PointCloud scan;
  for (int beam = 0; beam < scanner.num_beams; ++beam) {
    const double share = (beam + 0.5) / scanner.num_beams;
    const double elevation = kRadPerDeg * std::lerp(scanner.min_elevation_deg, scanner.max_elevation_deg, share);
    for (int shot = 0; shot < scanner.num_azimuths; ++shot) {
      const double azimuth = 2 * std::numbers::pi * shot / scanner.num_azimuths;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation));
      const double range = first_hit(scene, map_from_scan.translation(), map_from_scan.linear() * direction);
      if (!std::isfinite(range)) continue;
      scan.positions.emplace_back((range + scanner.range_noise * normal(random)) * direction);
    }
  }
  return scan;
}

namespace {

PointCloud scan_village() {
  constexpr double kSpacing = 8;  // [m] between two stops
  const Scene scene = village();
  PointCloud survey;
  for (double x = -35; x <= 35; x += kSpacing) {
    const Eigen::Isometry3d pose(Eigen::Translation3d(x, -0.7, 2.2));
    const PointCloud scan =
        moved(scan_scene(scene, pose,
                         {.num_beams = 40, .num_azimuths = 900, .min_elevation_deg = -40, .max_elevation_deg = 35}),
              pose);
    survey.positions.insert(survey.positions.end(), scan.positions.begin(), scan.positions.end());
  }
  return survey;
}

}  // namespace

const PointCloud& survey_of_village() {
  static const PointCloud survey = scan_village();
  return survey;
}

PointCloud moved(PointCloud cloud, const Eigen::Isometry3d& target_from_cloud) {
  for (Eigen::Vector3d& point : cloud.positions) point = target_from_cloud * point;
  return cloud;
}

}  // namespace vdbmap::test
