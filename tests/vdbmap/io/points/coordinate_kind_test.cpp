// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/coordinate_kind.h"

#include <gtest/gtest.h>

#include "tests/support/raw_files.h"
#include "vdbmap/io/las/geodetic_codes.h"

namespace vdbmap {
namespace {

ReadResult points(std::vector<Eigen::Vector3d> positions) {
  ReadResult read;
  read.cloud.positions = std::move(positions);
  read.epsg = 4979;
  return read;
}

std::string error_of(ReadResult read, CoordinateKind kind) {
  return test::io_error_of([&] { check_coordinates("a.las", read, kind); });
}

TEST(CoordinateKind, OneFarPointMakesNoMetresOfDegrees) {
  const ReadResult read = points({{13.4, 52.5, 30}, {13.5, 52.5, 30}, {1e6, 52.5, 30}});
  EXPECT_NE(error_of(read, CoordinateKind::kGeographic).find("degrees of longitude and latitude (EPSG:4979)"),
            std::string::npos);
}

TEST(CoordinateKind, MetresNeedNoSize) {
  EXPECT_EQ(error_of(points({{13.4, 52.5, 30}}), CoordinateKind::kProjected), "no error");
  EXPECT_EQ(error_of(points({{13.4, 52.5, 30}}), CoordinateKind::kUnknown), "no error");
}

TEST(CoordinateKind, AnEarthOfAnotherSizeIsAMistakeOfTheFile) {
  ReadResult read = points({{500000, 5800000, 30}});
  check_coordinates("a.las", read, CoordinateKind::kGeocentric);
  EXPECT_EQ(read.epsg, std::nullopt);
  ASSERT_EQ(read.findings.size(), 1U);
  EXPECT_TRUE(read.findings[0].is_damage);
}

TEST(GeodeticCodes, AreThoseOfDegreesAndOfTheEarthsCentre) {
  for (const int code : {4326, 4258, 4269, 4267, 4979, 4978, 7844, 6318, 3824, 4937, 9057}) {
    EXPECT_TRUE(is_geodetic_epsg(code)) << code;
  }
  for (const int code : {25832, 32633, 3857, 2154, 2229, 4647, 4559, 5514, 5683, 7856, 6339, 9388, 27700, 4217, 4390}) {
    EXPECT_FALSE(is_geodetic_epsg(code)) << code;
  }
}

}  // namespace
}  // namespace vdbmap
