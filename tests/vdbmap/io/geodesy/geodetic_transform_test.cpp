// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/geodesy/geodetic_transform.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "vdbmap/core/parallel.h"

namespace vdbmap {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kMajorAxis = 6378137;  // [m] of GRS 80 and of WGS 84
constexpr double kGrs80Flattening = 1 / 298.257222101;
constexpr double kWgs84Flattening = 1 / 298.257223563;
constexpr double kMicrometre = 1e-6;                            // [m]
constexpr double kMicrometreDegrees = 1e-6 / 6.4e6 / kRadians;  // a micrometre on the ground

// Length of the meridian from the equator [m]: its curvature, by Simpson's rule with steps of some 100 m.
double meridian_length(double latitude_deg, double flattening) {
  const double squared_eccentricity = flattening * (2 - flattening);
  const auto radius = [&](double phi) {
    return kMajorAxis * (1 - squared_eccentricity) *
           std::pow(1 - squared_eccentricity * std::pow(std::sin(phi), 2), -1.5);
  };
  constexpr int kSteps = 50'000;
  const double step = latitude_deg * kRadians / kSteps;
  double sum = radius(0) + radius(kSteps * step);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * radius(i * step);
  return sum * step / 3;
}

// Torge, Geodesy: the closed form of a place about the centre of the Earth.
Eigen::Vector3d ecef_of(const Eigen::Vector3d& lon_lat_height) {
  const double lambda = lon_lat_height.x() * kRadians, phi = lon_lat_height.y() * kRadians;
  const double squared_eccentricity = kWgs84Flattening * (2 - kWgs84Flattening);
  const double normal = kMajorAxis / std::sqrt(1 - squared_eccentricity * std::pow(std::sin(phi), 2));
  const double height = lon_lat_height.z();
  return {(normal + height) * std::cos(phi) * std::cos(lambda), (normal + height) * std::cos(phi) * std::sin(lambda),
          (normal * (1 - squared_eccentricity) + height) * std::sin(phi)};
}

TEST(GeodeticTransform, TheCentralMeridianOfAUtmZoneIsAsLongAsTheMeridian) {
  const GeodeticTransform transform(25832);
  for (const double latitude : {1.0, 30.0, 52.4, 70.0}) {
    const double northing = 0.9996 * meridian_length(latitude, kGrs80Flattening);
    const Eigen::Vector3d place = transform.to_wgs84({500'000, northing, 50});
    EXPECT_NEAR(place.x(), 9, kMicrometreDegrees);
    EXPECT_NEAR(place.y(), latitude, kMicrometreDegrees);
    EXPECT_EQ(place.z(), 50);
  }
}

TEST(GeodeticTransform, TheSphericalMercatorProjectionIsItsFormula) {
  const GeodeticTransform transform(3857);
  const double longitude = -71.25, latitude = 42.35;
  const Eigen::Vector3d place = transform.from_wgs84({longitude, latitude, 3});
  EXPECT_NEAR(place.x(), kMajorAxis * longitude * kRadians, kMicrometre);
  EXPECT_NEAR(place.y(), kMajorAxis * std::log(std::tan((45 + latitude / 2) * kRadians)), kMicrometre);
  EXPECT_EQ(place.z(), 3);
}

TEST(GeodeticTransform, KnowsTheTowerOfToronto) {
  // The example of encyclopedias for UTM: 43 38 33.24 N, 79 23 13.7 W is 630084 m E, 4833438 m N of zone 17, rounded.
  const Eigen::Vector3d place =
      GeodeticTransform(32617).from_wgs84({-(79 + 23 / 60.0 + 13.7 / 3600), 43 + 38 / 60.0 + 33.24 / 3600, 0});
  EXPECT_NEAR(place.x(), 630'084, 2);  // a tenth of a second is 2 m
  EXPECT_NEAR(place.y(), 4'833'438, 2);
}

TEST(GeodeticTransform, PlacesAboutTheCentreOfTheEarthAreThoseOfTheClosedForm) {
  const GeodeticTransform transform(25832, 43.2);
  const Eigen::Vector3d original(548'321.25, 5'802'114.5, 57.75);
  const Eigen::Vector3d place = transform.to_wgs84(original);
  EXPECT_NEAR(place.z(), 57.75 + 43.2, 1e-12);
  EXPECT_LT((transform.to_ecef(original) - ecef_of(place)).norm(), kMicrometre);
}

TEST(GeodeticTransform, ComesBackToWhereItBegan) {
  const Eigen::Vector3d original(548'321.25, 5'802'114.5, 57.75);
  for (const int epsg : {25832, 32632, 3857, 31467, 2056}) {  // 31467 has northings first and another datum
    const GeodeticTransform transform(epsg, 12);
    const Eigen::Vector3d place = epsg == 25832 || epsg == 32632 ? original : transform.from_wgs84({8.5, 47.3, 400});
    EXPECT_LT((transform.from_wgs84(transform.to_wgs84(place)) - place).norm(), 1e-5) << epsg;
  }
}

TEST(GeodeticTransform, EastingsComeFirstWhateverTheOrderOfTheSystemsAxes) {
  // Gauss-Krueger zone 3 says northing, easting. Its central meridian is 9 degrees; the datum moves it by some 100 m.
  const Eigen::Vector3d place = GeodeticTransform(31467).to_wgs84({3'500'000, 5'800'000, 0});
  EXPECT_NEAR(place.x(), 9, 0.01);
  EXPECT_NEAR(place.y(), 52.3, 0.1);
}

TEST(GeodeticTransform, SystemsInFeetGiveHeightsInMetres) {
  // The same projection and datum, in metres and in US survey feet.
  const double foot = 1200.0 / 3937;
  const Eigen::Vector3d metres(300'000, 60'000, 30);
  const Eigen::Vector3d in_metres = GeodeticTransform(32118, 5).to_wgs84(metres);
  const Eigen::Vector3d in_feet = GeodeticTransform(2263, 5).to_wgs84(metres / foot);
  EXPECT_LT((in_metres - in_feet).head<2>().norm(), 10 * kMicrometreDegrees);
  EXPECT_NEAR(in_feet.z(), 35, 1e-9);
}

TEST(GeodeticTransform, CompoundSystemsKeepTheHeightsOfTheMap) {
  const Eigen::Vector3d original(548'321.25, 5'802'114.5, 57.75);
  EXPECT_EQ(GeodeticTransform(5555).to_wgs84(original), GeodeticTransform(25832).to_wgs84(original));
}

TEST(GeodeticTransform, ObjectsMoveAndWorkBesideEachOther) {
  const Eigen::Vector3d original(548'321.25, 5'802'114.5, 57.75);
  GeodeticTransform moved = GeodeticTransform(3857);
  moved = GeodeticTransform(25832);
  const GeodeticTransform transform = std::move(moved);
  const Eigen::Vector3d expected = transform.to_ecef(original);
  std::vector<Eigen::Vector3d> found(64);
  parallel_for(found.size(), [&](std::size_t i) { found[i] = GeodeticTransform(25832).to_ecef(original); });
  for (const Eigen::Vector3d& place : found) EXPECT_EQ(place, expected);
}

TEST(GeodeticTransform, RefusesWhatIsNoProjectedSystem) {
  for (const int epsg : {0, -5, 999'999, 4326, 4979, 4978, 5783}) {
    EXPECT_THROW(GeodeticTransform transform(epsg), std::invalid_argument) << epsg;
  }
  EXPECT_THROW(GeodeticTransform(25832, std::nan("")), std::invalid_argument);
}

TEST(GeodeticTransform, RefusesPlacesBeyondTheProjection) {
  const GeodeticTransform transform(25832);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(transform.to_wgs84({infinity, 0, 0}), std::invalid_argument);
  EXPECT_THROW(transform.to_wgs84({0, 0, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(transform.to_ecef({1e12, 1e12, 0}), std::invalid_argument);
  EXPECT_THROW(transform.from_wgs84({0, 95, 0}), std::invalid_argument);
  EXPECT_NO_THROW(transform.to_wgs84({500'000, 5'800'000, 0})) << "an error stays no longer than its place";
}

}  // namespace
}  // namespace vdbmap
