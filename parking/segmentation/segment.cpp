// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/segment.h"

#include "parking/segmentation/network.h"
#include "parking/segmentation/voxel_features.h"
#include "parking/segmentation/voxel_pyramid.h"

namespace vdbmap::parking {

std::vector<SurfaceClass> segment(const VoxelLevel& finest, const NetworkWeights& network) {
  const Rows scores = class_scores(network, make_pyramid(finest), voxel_features(finest));
  std::vector<SurfaceClass> classes(finest.size());
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Eigen::Index best = 0;
    scores.row(static_cast<Eigen::Index>(i)).maxCoeff(&best);
    classes[i] = static_cast<SurfaceClass>(best);
  }
  return classes;
}

}  // namespace vdbmap::parking
