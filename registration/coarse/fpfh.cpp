// SPDX-License-Identifier: GPL-3.0-or-later
#include "registration/coarse/fpfh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "registration/coarse/neighbors.h"
#include "vdbmap/core/parallel.h"

namespace vdbmap::registration {
namespace {

using Histogram = Eigen::Matrix<float, kFpfhBins, 1>;

int bin_of(double value, double low, double high) {
  const auto bin = static_cast<int>((value - low) / (high - low) * kBinsPerAngle);
  return std::clamp(bin, 0, kBinsPerAngle - 1);
}

void count(Histogram& histogram, const PairAngles& angles) {
  histogram[bin_of(angles.alpha, -1, 1)] += 1;
  histogram[kBinsPerAngle + bin_of(angles.phi, -1, 1)] += 1;
  histogram[2 * kBinsPerAngle + bin_of(angles.theta, -std::numbers::pi, std::numbers::pi)] += 1;
}

void normalize(Histogram& histogram) {
  for (int first = 0; first < kFpfhBins; first += kBinsPerAngle) {
    const float sum = histogram.segment<kBinsPerAngle>(first).sum();
    if (sum > 0) histogram.segment<kBinsPerAngle>(first) /= sum;
  }
}

// SPFH: the angles between each point and its neighbours alone.
FpfhMatrix simple_features(const VoxelLevel& level, const SurfacePoints& points, double radius) {
  FpfhMatrix features(kFpfhBins, static_cast<Eigen::Index>(points.size()));
  parallel_for_each_with_finder(level, [&](const VoxelFinder& finder, const VoxelIndex& voxel, std::size_t number) {
    Histogram histogram = Histogram::Zero();
    for_each_neighbor(finder, level, points.positions, voxel, number, radius, [&](std::size_t other, double) {
      count(histogram, pair_angles(points.positions[number], points.normals[number], points.positions[other],
                                   points.normals[other]));
    });
    normalize(histogram);
    features.col(static_cast<Eigen::Index>(number)) = histogram;
  });
  return features;
}

}  // namespace

PairAngles pair_angles(const Eigen::Vector3d& point_a, const Eigen::Vector3d& normal_a, const Eigen::Vector3d& point_b,
                       const Eigen::Vector3d& normal_b) {
  const Eigen::Vector3d line = (point_b - point_a).normalized();
  const double cosine_a = normal_a.dot(line);
  const double cosine_b = normal_b.dot(line);
  const bool a_is_source = std::abs(cosine_a) >= std::abs(cosine_b);
  const Eigen::Vector3d& u = a_is_source ? normal_a : normal_b;
  const Eigen::Vector3d& n = a_is_source ? normal_b : normal_a;
  const Eigen::Vector3d across = a_is_source ? line.cross(u) : u.cross(line);  // the line runs from the source
  const double length = across.norm();
  const double phi = a_is_source ? cosine_a : -cosine_b;
  if (length < 1e-9) return {0, phi, 0};  // the line lies along the normal: no frame

  const Eigen::Vector3d v = across / length;
  const Eigen::Vector3d w = u.cross(v);
  return {v.dot(n), phi, std::atan2(w.dot(n), u.dot(n))};
}

FpfhMatrix fpfh_features(const VoxelLevel& level, const SurfacePoints& points, double radius) {
  const FpfhMatrix simple = simple_features(level, points, radius);
  FpfhMatrix features(kFpfhBins, simple.cols());
  parallel_for_each_with_finder(level, [&](const VoxelFinder& finder, const VoxelIndex& voxel, std::size_t number) {
    Histogram sum = Histogram::Zero();
    float num_neighbors = 0;
    for_each_neighbor(finder, level, points.positions, voxel, number, radius,
                      [&](std::size_t other, double squared_distance) {
                        const auto weight = static_cast<float>(1 / std::sqrt(std::max(squared_distance, 1e-6)));
                        sum += weight * simple.col(static_cast<Eigen::Index>(other));
                        ++num_neighbors;
                      });
    Histogram feature = simple.col(static_cast<Eigen::Index>(number));
    if (num_neighbors > 0) feature += sum / num_neighbors;
    normalize(feature);
    features.col(static_cast<Eigen::Index>(number)) = feature;
  });
  return features;
}

}  // namespace vdbmap::registration
