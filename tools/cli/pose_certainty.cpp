// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/pose_certainty.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>

#include "vdbmap/core/error.h"

namespace vdbmap::cli {
namespace {

// JSON has no infinity: what the map does not determine is null.
double number_or_infinity(const nlohmann::json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

// The block of a covariance of a small motion (rotation first) that is of the translation.
Eigen::Matrix3d translation_covariance(const nlohmann::json& covariance) {
  Eigen::Matrix3d block;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      block(row, column) = number_or_infinity(covariance.at(row + 3).at(column + 3));
  }
  return block;
}

double largest_sigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues().maxCoeff(), 0.0));
}

std::string name_of(const nlohmann::json& row) {
  ScanPlace place{row.at("file").get<std::string>(), std::nullopt};
  if (row.contains("turn")) place.turn = row.at("turn").get<std::size_t>() - 1;
  return place.name();
}

}  // namespace

std::optional<double> PoseCertainty::position_sigma(const ScanPlace& scan) const {
  const auto found = sigmas.find(scan.name());
  return found == sigmas.end() ? std::nullopt : std::optional(found->second);
}

PoseCertainty read_pose_certainty(const std::filesystem::path& report) {
  std::ifstream stream(report);
  if (!stream) throw IoError::system(report, "cannot open", errno);
  PoseCertainty certainty;
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    for (const nlohmann::json& row : json.at("results")) {
      if (!row.at("found").get<bool>()) continue;
      certainty.sigmas[name_of(row)] = largest_sigma(translation_covariance(row.at("covariance")));
    }
  } catch (const nlohmann::json::exception& error) {
    throw IoError::malformed(report, std::string("is no report of vdbmap localize: ") + error.what());
  }
  return certainty;
}

}  // namespace vdbmap::cli
