// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/coordinate_kind.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr const char* kAdvice =
    ": project it to metres first, for example with 'pdal translate IN OUT reprojection "
    "--filters.reprojection.out_srs=EPSG:32632'";

bool may_be_degrees(const Eigen::Vector3d& point) { return std::abs(point.x()) <= 360 && std::abs(point.y()) <= 360; }

// Between the deepest drill and the highest aeroplane, and then some.
bool may_be_geocentric(const Eigen::Vector3d& point) {
  const double radius = point.norm();  // [m]
  return radius > 6.3e6 && radius < 6.45e6;
}

bool has_kind(const PointCloud& cloud, CoordinateKind kind) {
  const auto is_of_kind = kind == CoordinateKind::kGeographic ? may_be_degrees : may_be_geocentric;
  return 2 * std::ranges::count_if(cloud.positions, is_of_kind) > std::ssize(cloud.positions);
}

}  // namespace

void check_coordinates(const std::filesystem::path& path, ReadResult& read, CoordinateKind kind) {
  if (kind != CoordinateKind::kGeographic && kind != CoordinateKind::kGeocentric) return;
  const bool is_geographic = kind == CoordinateKind::kGeographic;
  const std::string code = read.epsg ? " (EPSG:" + std::to_string(*read.epsg) + ")" : "";
  const std::string name = (is_geographic ? "degrees of longitude and latitude" : "geocentric") + code;
  if (has_kind(read.cloud, kind)) {
    const std::string reason = is_geographic ? ", not metres" : ", and z does not point up";
    throw IoError::malformed(path, "its coordinates are " + name + reason + kAdvice);
  }
  add_finding(read.findings,
              {"the file says that its coordinates are " + name + ", but they are too " +
                   (is_geographic ? "large" : "near or far") + " for that: taken as metres of an unknown system",
               0, "", true});
  read.epsg = std::nullopt;
}

}  // namespace vdbmap
