// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "vdbmap/io/scans/scan_sequence.h"

namespace vdbmap::cli {

/// A matrix as an array of rows.
template <typename Matrix>
nlohmann::ordered_json json_of_matrix(const Matrix& matrix) {
  auto rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    auto row = nlohmann::ordered_json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The fields that name a scan: its file and, in a capture, its turn, counted from 1.
nlohmann::ordered_json json_of_place(const ScanPlace& scan);

}  // namespace vdbmap::cli
