// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "registration/odometry/odometry.h"
#include "vdbmap/io/poses/trajectory_file.h"

namespace vdbmap::registration {

/// The poses of an odometry's steps, nothing for scans that were not registered, with the times [s] of their first
/// points; nan for those without usable ones. Without times where none has any, and where they begin anew in each scan.
Trajectory trajectory_of(std::span<const OdometryStep> steps);

}  // namespace vdbmap::registration
