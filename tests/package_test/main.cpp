// SPDX-License-Identifier: GPL-3.0-or-later
#include <parking/segmentation/network_weights.h>
#include <registration/trajectory_error.h>
#include <vdbmap/io/poses/trajectory_file.h>
#include <vdbmap/render/image.h>

int main(int, char** argv) {
  vdbmap::Trajectory trajectory;
  trajectory.map_from_scan = {Eigen::Isometry3d::Identity()};
  vdbmap::write_trajectory(argv[1], trajectory, vdbmap::TrajectoryFormat::kKitti);
  const auto error = vdbmap::registration::evaluate_trajectory(vdbmap::read_trajectory(argv[1]), trajectory);
  const bool has_picture = vdbmap::png_of(vdbmap::Image(2, 2)).starts_with("\x89PNG");
  const auto network = vdbmap::parking::read_network(argv[2]);
  return error.xy.max == 0 && has_picture && network->scores.bias.size() == 7 ? 0 : 1;
}
