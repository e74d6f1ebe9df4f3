// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "parking/segmentation/network_weights.h"
#include "parking/segmentation/voxel_pyramid.h"

namespace vdbmap::parking {

/// Scores of the classes (voxels x 7, before a softmax) for each voxel of the finest level, from its features (voxels x
/// 4). Level by level over the whole pyramid, so nothing is computed twice. The same for any number of threads.
Rows class_scores(const NetworkWeights& network, const VoxelPyramid& pyramid, const Rows& features);

/// Kernel points of a convolution [voxels], a column each: the middle, six on the axes (-x, +x, -y, ...), eight towards
/// the corners of a cube, all at 1.5 voxels.
Eigen::Matrix<float, 3, kNumKernelPoints> kernel_points();

}  // namespace vdbmap::parking
