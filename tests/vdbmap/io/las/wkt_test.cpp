// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/wkt.h"

#include <string>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

const std::string kGeographic = R"(GEOGCS["NAD83",DATUM["North_American_Datum_1983",
    SPHEROID["GRS 1980",6378137,298.257222101,AUTHORITY["EPSG","7019"]],AUTHORITY["EPSG","6269"]],
    PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4269"]])";

std::string projected(const std::string& end) {
  return "PROJCS[\"NAD83 / Oregon\"," + kGeographic + R"(,PROJECTION["Lambert_Conformal_Conic_2SP"],
    PARAMETER["false_easting",400000],)" +
         end + "]";
}

TEST(Wkt, ProjectedSystemHasItsOwnCodeAndUnit) {
  const auto parsed =
      parse_wkt(projected(R"(UNIT["foot, international",0.3048,AUTHORITY["EPSG","9002"]],AUTHORITY["EPSG","2994"])"));
  EXPECT_EQ(parsed.epsg, 2994);
  EXPECT_EQ(parsed.metres_per_unit, 0.3048);
}

TEST(Wkt, CodesOfPartsAreNotThatOfTheWhole) {
  const auto parsed = parse_wkt(projected(R"(UNIT["foot",0.3048,AUTHORITY["EPSG","9002"]])"));
  EXPECT_EQ(parsed.epsg, std::nullopt);
  EXPECT_EQ(parsed.metres_per_unit, 0.3048);
  EXPECT_EQ(parse_wkt(projected(R"(AUTHORITY["ESRI","102970"])")).epsg, std::nullopt);
}

TEST(Wkt, CompoundSystemGivesItsHorizontalPart) {
  const auto parsed =
      parse_wkt("COMPD_CS[\"x + height\"," + projected(R"(UNIT["metre",1],AUTHORITY["EPSG","26910"])") +
                R"(,VERT_CS["h",UNIT["foot",0.3048],AUTHORITY["EPSG","5703"]],AUTHORITY["EPSG","9999"]])");
  EXPECT_EQ(parsed.epsg, 26910);
  EXPECT_EQ(parsed.metres_per_unit, 1.0);
}

TEST(Wkt, GeographicSystemHasNoLength) {
  const auto parsed = parse_wkt(kGeographic);
  EXPECT_EQ(parsed.epsg, 4269);
  EXPECT_EQ(parsed.metres_per_unit, std::nullopt);
}

TEST(Wkt, TheNewerFormIsUnderstood) {
  const auto parsed = parse_wkt(R"wkt(PROJCRS["ETRS89 / UTM 32N",BASEGEOGCRS["ETRS89",ID["EPSG",4258]],
      CONVERSION["UTM 32N",PARAMETER["False easting",500000,LENGTHUNIT["metre",1]]],CS[Cartesian,2],
      AXIS["(E)",east,ORDER[1],LENGTHUNIT["US survey foot",0.3048006096012192]],
      AXIS["(N)",north],ID["EPSG",25832]])wkt");
  EXPECT_EQ(parsed.epsg, 25832);
  EXPECT_NEAR(*parsed.metres_per_unit, 1200. / 3937, 1e-15);
}

TEST(Wkt, TruncationAnywhereIsHarmless) {
  const std::string whole = projected(R"(UNIT["metre",1],AUTHORITY["EPSG","26910"])");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(parse_wkt(std::string_view(whole).substr(0, size)).epsg, std::nullopt) << size;
  }
}

TEST(Wkt, NestingOfAnyDepthTakesNoStack) {
  // A stack of 8 MB holds some 60,000 calls; looking into each bracket anew would take hours.
  for (const std::string keyword : {"AXIS", "UNIT", "PROJCS", "PROJCRS", "COMPD_CS", "BOUNDCRS", "GEOGCS", "ID", ""}) {
    for (const std::string bracket : {"[", "("}) {
      std::string nested = "PROJCS[";
      for (int i = 0; i < 300'000; ++i) nested += keyword + bracket;
      const auto parsed = parse_wkt(nested);
      EXPECT_EQ(parsed.epsg, std::nullopt) << keyword;
      EXPECT_EQ(parsed.metres_per_unit, std::nullopt) << keyword;
      EXPECT_EQ(parse_wkt(nested.substr(7)).epsg, std::nullopt) << keyword;
    }
  }
}

TEST(Wkt, NonsenseSaysNothing) {
  for (const std::string text :
       {"", "]]]]", "PROJCS", "PROJCS[]", "PROJCS[UNIT[]]", "PROJCS[UNIT[\"x\",-1]]",
        "PROJCS[UNIT[\"x\",nan],AUTHORITY[\"EPSG\",\"99999999999\"]]", "PROJCS[AUTHORITY[\"EPSG\"]]"}) {
    EXPECT_EQ(parse_wkt(text).epsg, std::nullopt) << text;
    EXPECT_EQ(parse_wkt(text).metres_per_unit, std::nullopt) << text;
  }
  EXPECT_EQ(parse_wkt(std::string(1'000'000, '[')).epsg, std::nullopt);
}

}  // namespace
}  // namespace vdbmap
