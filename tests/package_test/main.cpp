// SPDX-License-Identifier: GPL-3.0-or-later
#include <registration/trajectory_error.h>
#include <vdbmap/io/trajectory_file.h>

int main(int, char** argv) {
  vdbmap::Trajectory trajectory;
  trajectory.map_from_scan = {Eigen::Isometry3d::Identity()};
  vdbmap::write_trajectory(argv[1], trajectory, vdbmap::TrajectoryFormat::kKitti);
  const auto error = vdbmap::registration::evaluate_trajectory(vdbmap::read_trajectory(argv[1]), trajectory);
  return error.xy.max == 0 ? 0 : 1;
}
