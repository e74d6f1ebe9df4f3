// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "registration/fine/plane_residual.h"

namespace vdbmap::registration {

/// A direction in which the matched planes do not hold the scan.
struct UnobservableDirection {
  Vector6d motion;          ///< unit: rotation vector times a lever of 10 m, then translation; axes of the map
  std::string description;  ///< like "translation along (0.99, 0.10, 0.01)"
};

/// Covariance of the pose: rotation [rad^2] about the sensor, then translation [m^2], axes of the map.
///
/// The sandwich of White (1980), so that residuals of unequal spread count as they are, for a robust kernel as Huber
/// (1967) has it and for few points (HC3 of MacKinnon & White 1985): `slopes` are the derivatives of weight times
/// distance by the distance. Where the distances of each of 36 sectors about the scanner's axis clearly go together, as
/// deskewing and surfaces that are no planes make them, those of a sector count as one (the jackknife of clusters,
/// MacKinnon, Nielsen & Webb 2023). Along directions that the planes do not determine it is that of the guesses we
/// accept: 2 m and 10 degrees.
Matrix6d motion_covariance(std::span<const PlaneMatch> matches, std::span<const double> weights,
                           std::span<const double> slopes, const Eigen::Isometry3d& map_from_scan);

/// The same where the weights do not depend on the distances.
inline Matrix6d motion_covariance(std::span<const PlaneMatch> matches, std::span<const double> weights,
                                  const Eigen::Isometry3d& map_from_scan) {
  return motion_covariance(matches, weights, weights, map_from_scan);
}

/// Directions in which a unit motion changes the distances by less than 3 % of it, root mean square.
std::vector<UnobservableDirection> unobservable_directions(std::span<const PlaneMatch> matches,
                                                           std::span<const double> weights,
                                                           const Eigen::Isometry3d& map_from_scan);

}  // namespace vdbmap::registration
