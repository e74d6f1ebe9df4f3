// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/surveyed_place.h"

#include "tests/support/ray_visibility.h"
#include "vdbmap/core/map_builder.h"

namespace vdbmap::test {

Survey survey_of(const Scene& scene, const SurveyOptions& options) {
  constexpr int kNumStops = 9;
  constexpr double kBetweenStops = 2;  // [m]
  PointCloud cloud;
  std::vector<MeasuredRay> rays;
  for (int stop = 0; stop < kNumStops; ++stop) {
    const Eigen::Vector3d place(options.first_stop + kBetweenStops * stop, -1, 1.9);
    const Eigen::Isometry3d map_from_scan(Eigen::Translation3d(place + options.shift));
    const Scanner scanner{.num_beams = 64,
                          .num_azimuths = 900,
                          .min_elevation_deg = -60,
                          .max_elevation_deg = 20,
                          .range_noise = options.noise,
                          .seed = 1000 * options.seed + static_cast<unsigned>(stop)};
    const PointCloud scan = scan_scene(scene, Eigen::Isometry3d(Eigen::Translation3d(place)), scanner);
    for (const Eigen::Vector3d& point : scan.positions) {
      cloud.positions.emplace_back(map_from_scan * point);
      rays.push_back({map_from_scan.translation(), cloud.positions.back()});
    }
  }
  BuildOptions build;
  build.voxel_sizes = {options.voxel_size};
  build.anchor = options.anchor;
  Survey survey{build_map(cloud, build), {}};
  survey.visibility = visibility_of(survey.map, rays);
  return survey;
}

Scene lane(const LaneOptions& options) {
  constexpr double kBegin = -12, kLength = 24, kPavement = 0.12;  // [m]
  const Eigen::Vector3d along(kLength, 0, 0);
  Scene scene = {
      {{kBegin, -6, 0}, along, {0, 6 + options.kerb_y, 0}},
      {{kBegin, options.kerb_y, 0}, along, {0, 0, kPavement}},
      {{kBegin, options.kerb_y, kPavement}, along, {0, options.wall_y - options.kerb_y, 0}},
      {{kBegin, options.wall_y, kPavement}, along, {0, 0, 4}},
  };
  const auto add = [&](const Scene& thing) { scene.insert(scene.end(), thing.begin(), thing.end()); };
  if (options.has_car) add(box({1.8, 2.0, 0.2}, {6.2, 3.8, 1.7}));
  add(box({-6, -5, 0}, {-3, -4.9, 2.5}));  // the screen
  if (options.has_hidden_box) add(box({-4.9, -5.9, 0}, {-4.1, -5.3, 0.8}));
  return scene;
}

}  // namespace vdbmap::test
