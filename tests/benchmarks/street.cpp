// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/street.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>

#include "tests/benchmarks/random.h"

namespace vdbmap::benchmarks {
namespace {

constexpr double kDensity = 500;                      // [points / m^2]
constexpr double kNoise = 0.005;                      // [m] standard deviation across the surface
constexpr double kBlockLength = 60;                   // [m] of street made at once
const Eigen::Vector3d kOrigin(691000, 5334000, 515);  // [m] as in UTM

struct Color {
  double r, g, b;  // 0..255
};

// A flat piece of surface.
struct Patch {
  Eigen::Vector3d corner;
  Eigen::Vector3d u;  // its edges [m]
  Eigen::Vector3d v;
  Color color;
};

class StreetMaker {
 public:
  // Everything between x and x + kBlockLength; what crosses the end is part of it.
  void add_block(double x) {
    add_ground(x);
    for (const double side : {-1.0, 1.0}) {
      add_facades(x, side);
      add_cars(x, side);
      add_poles_and_trees(x, side);
    }
  }

  std::size_t size() const { return cloud_.size(); }

  // In the order in which a scanner on a car passes the points: a profile every 5 cm.
  PointCloud in_profiles() const {
    std::vector<std::uint32_t> order(cloud_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    const auto profile = [&](std::uint32_t i) { return std::floor(cloud_.positions[i].x() * 20); };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return profile(a) < profile(b); });

    PointCloud sorted;
    for (const std::uint32_t i : order) {
      sorted.positions.push_back(kOrigin + cloud_.positions[i]);
      sorted.colors.push_back(cloud_.colors[i]);
    }
    return sorted;
  }

 private:
  // Near to normal, without a logarithm or cosine that libraries round as they like: the sum of twelve uniform numbers
  // (Irwin & Hall), at most six deviations off.
  double noise(double deviation) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random_.uniform(0, 1);
    return deviation * sum;
  }

  void add_point(const Eigen::Vector3d& point, const Color& color) {
    const double shade = noise(6);
    const auto code = [&](double value) {
      return static_cast<std::uint16_t>(257 * static_cast<int>(std::clamp(value + shade, 0.0, 255.0)));
    };
    cloud_.positions.push_back(point);
    cloud_.colors.push_back({code(color.r), code(color.g), code(color.b)});
  }

  void add_patch(const Patch& patch) {
    const Eigen::Vector3d cross = patch.u.cross(patch.v);
    const auto count = static_cast<std::size_t>(cross.norm() * kDensity);
    for (std::size_t i = 0; i < count; ++i) {
      const double u = random_.uniform(0, 1);
      const double v = random_.uniform(0, 1);
      add_point(patch.corner + u * patch.u + v * patch.v + cross.normalized() * noise(kNoise), patch.color);
    }
  }

  void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& size, const Color& color) {
    const Eigen::Vector3d x(size.x(), 0, 0);
    const Eigen::Vector3d y(0, size.y(), 0);
    const Eigen::Vector3d z(0, 0, size.z());
    for (const Eigen::Vector3d& corner : {low, Eigen::Vector3d(low + y)}) add_patch({corner, x, z, color});
    for (const Eigen::Vector3d& corner : {low, Eigen::Vector3d(low + x)}) add_patch({corner, y, z, color});
    add_patch({low + z, x, y, color});
  }

  void add_pole(const Eigen::Vector3d& foot, double radius, double height, const Color& color) {
    const auto count = static_cast<std::size_t>(2 * std::numbers::pi * radius * height * kDensity);
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = random_.uniform(0, 2 * std::numbers::pi);
      const double r = radius + noise(kNoise);
      add_point(foot + Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), random_.uniform(0, height)), color);
    }
  }

  // A ball of leaves, denser towards its hull.
  void add_crown(const Eigen::Vector3d& center, double radius, const Color& color) {
    const auto count = static_cast<std::size_t>(4 * std::numbers::pi * radius * radius * kDensity);
    for (std::size_t i = 0; i < count; ++i) {
      const double r = radius * std::sqrt(random_.uniform(0.2, 1));
      add_point(center + r * random_direction(random_), color);
    }
  }

  // A road with camber and slope, kerbs of 12 cm, pavements.
  void add_ground(double x) {
    const Eigen::Vector3d along(kBlockLength, 0, 0.01 * kBlockLength);
    const auto at = [&](double y, double z) { return Eigen::Vector3d(x, y, z + 0.01 * x); };
    for (const double side : {-1.0, 1.0}) {
      add_patch({at(0, 0), along, {0, 6 * side, -0.12}, {90, 90, 95}});
      add_patch({at(6 * side, -0.12), along, {0, 0, 0.12}, {150, 150, 145}});
      add_patch({at(6 * side, 0), along, {0, 4 * side, 0.06}, {140, 135, 130}});
    }
  }

  // Houses 15 m wide, their windows set back by 20 cm; three of ten points on glass come back.
  void add_facades(double x, double side) {
    constexpr double kWidth = 15;
    for (double left = x; left < x + kBlockLength; left += kWidth) {
      const double height = random_.uniform(9, 15);
      const double front = 10 + random_.uniform(0, 0.7);
      const Color color{random_.uniform(120, 230), random_.uniform(110, 200), random_.uniform(100, 180)};
      const auto count = static_cast<std::size_t>(kWidth * height * kDensity);
      for (std::size_t i = 0; i < count; ++i) {
        const double across = random_.uniform(0, kWidth);
        const double up = random_.uniform(0, height);
        const bool is_window = std::fmod(across, 3) > 1.8 && std::fmod(up, 3) > 1.2 && std::fmod(up, 3) < 2.7;
        if (is_window && random_.uniform(0, 1) > 0.3) continue;
        const double depth = front + (is_window ? 0.2 : 0) + noise(kNoise);
        add_point({left + across, side * depth, up + 0.01 * left}, is_window ? Color{40, 50, 60} : color);
      }
    }
  }

  // One place of 6 m in three is free.
  void add_cars(double x, double side) {
    for (double place = x; place < x + kBlockLength; place += 6) {
      if (random_.uniform(0, 1) < 0.33) continue;
      const Eigen::Vector3d low(place + random_.uniform(0.3, 1), side * 5 - 0.9, 0.2 + 0.01 * place);
      const Color color{random_.uniform(20, 240), random_.uniform(20, 240), random_.uniform(20, 240)};
      add_box(low, {4.4, 1.8, 0.7}, color);
      add_box(low + Eigen::Vector3d(0.9, 0.15, 0.7), {2.4, 1.5, 0.55}, {30, 35, 40});
    }
  }

  void add_poles_and_trees(double x, double side) {
    for (double place = x + 5; place < x + kBlockLength; place += 20) {
      const Eigen::Vector3d foot(place, side * 6.7, 0.01 * place);
      add_pole(foot, 0.08, 7, {110, 115, 110});
      const Eigen::Vector3d tree = foot + Eigen::Vector3d(10, 0, 0);
      add_pole(tree, 0.15, 3.5, {90, 70, 50});
      add_crown(tree + Eigen::Vector3d(0, 0, 4.7), 1.6, {60, 110, 45});
    }
  }

  Random random_{5};
  PointCloud cloud_;
};

}  // namespace

PointCloud make_street(std::size_t num_points) {
  StreetMaker maker;
  for (double x = 0; maker.size() < num_points; x += kBlockLength) maker.add_block(x);
  PointCloud street = maker.in_profiles();
  street.positions.resize(num_points);
  street.colors.resize(num_points);
  return street;
}

}  // namespace vdbmap::benchmarks
