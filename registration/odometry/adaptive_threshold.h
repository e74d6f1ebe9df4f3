// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

namespace vdbmap::registration {

/// How far a scan may lie from where the motion predicts it, learnt from the deviations so far (Vizzo 2023, section
/// III-C).
class AdaptiveThreshold {
 public:
  /// Standard deviation until something is learnt, and the least deviation that counts [m]. `max_range` [m] turns
  /// angles into lengths. Throws std::invalid_argument unless all are positive.
  AdaptiveThreshold(double initial, double min_deviation, double max_range);

  /// sigma_t [m]: the root mean square of the deviations that count.
  double sigma() const;

  /// Learns from the motion between the predicted and the found pose of a scan.
  void add_deviation(const Eigen::Isometry3d& predicted_from_found);

 private:
  double initial_;
  double min_deviation_;
  double max_range_;
  double sum_of_squares_ = 0;
  std::size_t count_ = 0;
};

/// The greatest shift of a point within `max_range` [m] by a motion (Vizzo 2023, section III-C) [m].
double deviation_at_range(const Eigen::Isometry3d& motion, double max_range);

}  // namespace vdbmap::registration
