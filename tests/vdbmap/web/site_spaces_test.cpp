// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/site_spaces.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/io/geodesy/geodetic_transform.h"

namespace vdbmap {
namespace {

constexpr double kOffset = 43;  // [m]
const std::string kMapSystem = R"("crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}, )";

// A box of 5 m by 2 m from (x, y) on [m, local frame], at height 52.
std::vector<Eigen::Vector3d> box_at(double x, double y) {
  return {{x, y, 52}, {x + 5, y, 52}, {x + 5, y + 2, 52}, {x, y + 2, 52}};
}

std::string position(const Eigen::Vector3d& p) {
  std::ostringstream text;
  text.precision(15);
  text << "[" << p.x() << ", " << p.y() << ", " << p.z() << "]";
  return text.str();
}

// A feature with these corners, closed, and these properties.
std::string feature(const std::vector<Eigen::Vector3d>& corners, const std::string& properties) {
  std::string ring;
  for (const Eigen::Vector3d& corner : corners) ring += position(corner) + ", ";
  return R"({"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [[)" + ring + position(corners.front()) +
         R"(]]}, "properties": {)" + properties + "}}";
}

std::vector<Eigen::Vector3d> in_original(std::vector<Eigen::Vector3d> corners) {
  for (Eigen::Vector3d& corner : corners) corner += test::kUtm;
  return corners;
}

class SiteSpaces : public testing::Test {
 protected:
  EpochSpaces read(const std::string& features, const std::string& crs = kMapSystem) const {
    std::ofstream(folder_ / "a.geojson") << R"({"type": "FeatureCollection", )" << crs << "\"features\": [" << features
                                         << "]}";
    return read_site_spaces(folder_ / "a.geojson", place_);
  }

  std::string error_of(const std::string& features, const std::string& crs = kMapSystem) const {
    return test::io_error_of([&] { read(features, crs); });
  }

  test::TemporaryFolder folder_;
  SpacesPlace place_{{test::kUtm, 25832}, kOffset, {Eigen::Vector3d(0, 0, 50), Eigen::Vector3d(100, 100, 70)}};
};

void expect_outline(const SiteSpace& space, const std::vector<Eigen::Vector3d>& expected) {
  ASSERT_EQ(space.outline.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT((space.outline[i] - expected[i]).norm(), 1e-3);
}

TEST_F(SiteSpaces, AreReadInTheSystemOfTheMap) {
  const EpochSpaces epoch = read(
      feature(in_original(box_at(10, 20)),
              R"("id": "A7", "state": "vacant", "previous_state": "occupied", "confidence": 0.9, "vehicle_points": 3,
         "rays_through": 71, "length": 5, "width": 2, "heading": 1.5707963, "kerb_side": "S", "date": "2023-03-02")"));
  ASSERT_EQ(epoch.spaces.size(), 1U);
  const SiteSpace& space = epoch.spaces.front();
  expect_outline(space, box_at(10, 20));
  EXPECT_EQ(epoch.date, "2023-03-02");
  EXPECT_EQ(space.id, "A7");
  EXPECT_EQ(space.state.state, "vacant");
  EXPECT_EQ(space.state.previous_state, "occupied");
  EXPECT_EQ(space.state.rays_through, 71);
  EXPECT_NEAR(space.heading_deg, 90, 1e-5);
  EXPECT_EQ(space.kerb_side, "S");
}

TEST_F(SiteSpaces, AreReadInWgs84) {
  const GeodeticTransform transform(25832, kOffset);
  std::vector<Eigen::Vector3d> degrees = in_original(box_at(10, 20));
  for (Eigen::Vector3d& corner : degrees) corner = transform.to_wgs84(corner);
  expect_outline(read(feature(degrees, R"("id": 3)"), "").spaces.front(), box_at(10, 20));
}

TEST_F(SiteSpaces, OfALocalMapAreLocal) {
  place_.frame.epsg.reset();
  place_.frame.anchor.setZero();
  expect_outline(read(feature(box_at(10, 20), R"("id": 3)"), "").spaces.front(), box_at(10, 20));
}

TEST_F(SiteSpaces, OutlinesTurnAgainstTheClock) {
  std::vector<Eigen::Vector3d> clockwise = box_at(10, 20);
  std::ranges::reverse(clockwise);
  const SiteSpace space = read(feature(in_original(clockwise), R"("id": 3)")).spaces.front();
  double twice_area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d &a = space.outline[i], &b = space.outline[(i + 1) % 4];
    twice_area += a.x() * b.y() - b.x() * a.y();
  }
  EXPECT_NEAR(twice_area, 2 * 5 * 2, 1e-6);
}

TEST_F(SiteSpaces, WithoutAStateTheLastOfTheHistoryCounts) {
  const auto corners = in_original(box_at(0, 0));
  const EpochSpaces epoch =
      read(feature(corners, R"("id": 1, "history": [{"date": "2023-03-01", "state": "occupied"}])"));
  EXPECT_EQ(epoch.spaces.front().state.state, "occupied");
  EXPECT_EQ(epoch.date, "2023-03-01");
  EXPECT_EQ(read(feature(corners, R"("id": 1)")).spaces.front().state.state, "unknown");
}

TEST_F(SiteSpaces, RefusesWhatIsNoneNamingTheFeature) {
  const std::string good = feature(in_original(box_at(0, 0)), R"("id": 1)");
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_EQ(error_of(good + ", " + good), "a.geojson: feature 2 has the id of another");
  EXPECT_EQ(error_of(feature(in_original(box_at(0, 0)), R"("id": 1, "state": "full")")),
            "a.geojson: feature 1 has the state 'full', expected occupied, vacant or unknown");
  EXPECT_NE(error_of(feature(in_original(box_at(0, 0)), "")).find("feature 1 is no space"), std::string::npos);
  EXPECT_NE(error_of("7").find("feature 1 is no space"), std::string::npos);
  EXPECT_EQ(error_of(R"({"geometry": {"type": "Point"}, "properties": {"id": 1}})"),
            "a.geojson: feature 1 is no polygon");
  EXPECT_NE(error_of(good, R"("crs": {"properties": {"name": "EPSG:31467"}}, )").find("EPSG:25832"), std::string::npos);
  EXPECT_NE(error_of(good, R"("crs": 3, )").find("no GeoJSON of spaces"), std::string::npos);
  std::ofstream(folder_ / "b.geojson") << "{\"type\": \"FeatureColl";
  EXPECT_EQ(test::io_error_of([&] { read_site_spaces(folder_ / "b.geojson", place_); }),
            "b.geojson: is no GeoJSON of features");
}

TEST_F(SiteSpaces, OfAnotherPlaceAreRefused) {
  EXPECT_EQ(error_of(feature(in_original(box_at(150, 0)), R"("id": 1)")), "no error");
  EXPECT_EQ(error_of(feature(in_original(box_at(12'100, 0)), R"("id": 1)")),
            "a.geojson: has spaces of another place: the nearest is 12 km from the map");
}

TEST_F(SiteSpaces, OfSeveralEpochsAreOneListOfStates) {
  const auto corners = in_original(box_at(0, 0));
  const EpochSpaces first = read(feature(corners, R"("id": "a", "state": "occupied")"));
  const EpochSpaces second = read(feature(corners, R"("id": "a", "state": "vacant", "previous_state": "occupied")") +
                                  ", " + feature(in_original(box_at(9, 0)), R"("id": "b", "state": "unknown")"));
  const nlohmann::json json = nlohmann::json::parse(spaces_json({{"1", first}, {"2", second}}));
  EXPECT_EQ(json["epochs"], nlohmann::json({"1", "2"}));
  ASSERT_EQ(json["spaces"].size(), 2U);
  EXPECT_EQ(json["spaces"][0]["id"], "a");
  ASSERT_EQ(json["spaces"][0]["states"].size(), 2U);
  EXPECT_EQ(json["spaces"][0]["states"][0]["state"], "occupied");
  EXPECT_EQ(json["spaces"][0]["states"][1]["epoch"], "2");
  EXPECT_EQ(json["spaces"][0]["states"][1]["previous_state"], "occupied");
  EXPECT_EQ(json["spaces"][1]["states"].size(), 1U);
  EXPECT_EQ(json["spaces"][1]["polygon"][1], nlohmann::json({14.0, 0.0, 52.0}));
}

}  // namespace
}  // namespace vdbmap
