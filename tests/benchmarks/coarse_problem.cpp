// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/coarse_problem.h"

#include <numbers>
#include <optional>
#include <random>

#include "registration/fine/point_to_plane.h"
#include "registration/odometry/odometry.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::benchmarks {
namespace {

std::optional<CoarseProblem> split(const Drive* drive, std::size_t batch_size) {
  if (!drive) return std::nullopt;
  CoarseProblem problem;
  problem.batch_size = batch_size;
  MapBuilder builder{BuildOptions()};
  registration::Odometry odometry;
  const registration::FineOptions fine;
  for (std::size_t i = 0; i < drive->scans.size(); ++i) {
    const PointCloud& scan = drive->scans[i];
    if (i % 2 == 0) {
      builder.add(scan, drive->map_from_scan[i]);
      continue;
    }
    problem.scans.push_back(&scan);
    problem.samples.push_back(
        registration::sample_scan(scan.positions, fine.fine_spacing, fine.coarse_spacing, fine.range));
    problem.odometry_from_scan.push_back(odometry.register_scan(scan).first_from_scan);
    problem.map_from_scan.push_back(drive->map_from_scan[i]);
  }
  problem.map = builder.finish();
  problem.coarse_map = registration::prepare_coarse_map(problem.map.coarsest());
  return problem;
}

}  // namespace

const CoarseProblem* drive_problem() {
  static const std::optional<CoarseProblem> problem = split(kitti_drive(), 20);
  return problem ? &*problem : nullptr;
}

const CoarseProblem* residential_problem() {
  static const std::optional<CoarseProblem> problem = split(kitti_residential(), 8);
  return problem ? &*problem : nullptr;
}

MovedBatch moved_batch(const CoarseProblem& problem, unsigned seed) {
  std::mt19937 random(seed);
  const auto share = [&] { return random() / 4294967296.0; };
  MovedBatch batch;
  batch.count = std::min(problem.batch_size, problem.scans.size());
  batch.first = random() % (problem.scans.size() - batch.count + 1);
  batch.moved_from_odometry.rotate(Eigen::AngleAxisd((2 * share() - 1) * std::numbers::pi, Eigen::Vector3d::UnitZ()));
  batch.moved_from_odometry.pretranslate(Eigen::Vector3d(200 * share() - 100, 200 * share() - 100, 0));
  return batch;
}

}  // namespace vdbmap::benchmarks
