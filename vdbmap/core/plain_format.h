// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace vdbmap {

/// The numbers of a row, one blank apart; Eigen's own format pads them to columns.
inline const Eigen::IOFormat kPlainFormat(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", " ");

}  // namespace vdbmap
