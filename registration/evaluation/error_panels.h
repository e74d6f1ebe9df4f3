// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Geometry>

#include "registration/trajectory_error.h"
#include "vdbmap/render/image.h"

/// Parts of the picture that plot_trajectory() makes.
namespace vdbmap::registration {

/// Draws the histogram of errors [m] over scans into the frame [pixels], in cm where they are small.
void draw_error_histogram(Image& image, const Eigen::AlignedBox2d& frame, const std::string& title,
                          std::span<const double> errors);

/// Writes the statistics, shares and counts of an evaluation, from the upper left corner [pixels] on.
void draw_error_figures(Image& image, const Eigen::Vector2d& corner, const TrajectoryError& error,
                        const std::optional<ErrorSummary>& aligned);

}  // namespace vdbmap::registration
