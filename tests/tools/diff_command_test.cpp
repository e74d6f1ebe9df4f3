// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/picture.h"
#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;
using test::CommandResult;

// Ground of 12 m x 8 m around the origin, evenly covered, and on request a block of 2 m x 1 m x 1 m on it.
PointCloud yard(bool has_block, double shift = 0) {
  PointCloud cloud;
  constexpr double kStep = 0.03;
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 266; ++j) {
      const double x = i * kStep - 6, y = j * kStep - 4;
      cloud.positions.emplace_back(x + shift, y, 0.01 * std::sin(7.0 * i + 3.0 * j));
      const bool is_on_block = has_block && x > 1 && x < 3 && y > 0 && y < 1;
      if (is_on_block) cloud.positions.back().z() += 1;
    }
  }
  for (int i = 0; has_block && i < 66; ++i) {
    for (int k = 0; k < 33; ++k) {
      cloud.positions.emplace_back(1 + i * kStep + shift, 0, k * kStep);
      cloud.positions.emplace_back(1 + i * kStep + shift, 1, k * kStep);
    }
  }
  return cloud;
}

class DiffCommandTest : public MapCommand {
 protected:
  // Clouds without rays: what the other does not hold counts as seen.
  std::string yard_map(const std::string& name, bool has_block, std::vector<std::string> options = {}) const {
    return built(name, moved(yard(has_block), kUtm), options);
  }
};

using DiffCommand = DiffCommandTest;

TEST_F(DiffCommand, SumsUpWhatChangedLikeGitDiffStat) {
  const CommandResult result =
      vdbmap({"diff", yard_map("a.vdb", false), yard_map("b.vdb", true), "--assume-seen", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("a.vdb -> b.vdb"), std::string::npos);
  EXPECT_NE(result.out.find("1 appeared"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("1 appeared (+)"), std::string::npos) << result.out;
}

TEST_F(DiffCommand, TellsProgramsTheSame) {
  const std::string a = yard_map("a.vdb", false), b = yard_map("b.vdb", true);
  const json diff = json_of({"diff", a, b, "--assume-seen"});
  for (const char* name : {"appeared", "vanished", "changed", "unchanged", "unobserved"}) {
    EXPECT_TRUE(diff["voxels"][name].is_number_unsigned()) << name;
  }
  ASSERT_GE(diff["regions"].size(), 1u);
  const json& region = diff["regions"][0];
  EXPECT_EQ(region["id"], 1);
  EXPECT_EQ(region["kind"], "appeared");
  EXPECT_NEAR(region["center"][0].get<double>(), kUtm.x() + 2, 0.1);
  EXPECT_NEAR(region["center"][1].get<double>(), kUtm.y() + 0.5, 0.1);
  EXPECT_NEAR(region["size"][0].get<double>(), 2, 0.15);
  EXPECT_NEAR(region["size"][1].get<double>(), 1, 0.15);
  EXPECT_NEAR(std::remainder(region["yaw"].get<double>(), 180), 0, 3);
  EXPECT_NEAR(region["volume_m3"].get<double>(), 1e-3 * region["voxels"].get<double>(), 1e-9);
  EXPECT_TRUE(region["label"].is_null());
  EXPECT_GT(region["confidence"].get<double>(), 0.5);

  // The other way around, and into a file.
  const CommandResult result = vdbmap({"diff", b, a, "--assume-seen", "--quiet", "--json", path("diff.json")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("vanished"), std::string::npos);
  std::ifstream file(path("diff.json"));
  EXPECT_EQ(json::parse(file)["voxels"]["vanished"], diff["voxels"]["appeared"]);
}

TEST_F(DiffCommand, TheExitCodeSaysWhetherSomethingChanged) {
  const std::string a = yard_map("a.vdb", false), b = yard_map("b.vdb", true);
  EXPECT_EQ(vdbmap({"diff", a, b, "--assume-seen", "--exit-code"}).exit_code, 1);
  EXPECT_EQ(vdbmap({"diff", a, a, "--assume-seen", "--exit-code"}).exit_code, 0);
  EXPECT_EQ(vdbmap({"diff", a, b, "--assume-seen"}).exit_code, 0);
}

TEST_F(DiffCommand, SaysThatMapsWithoutRaysKnowNothingOfWhatIsEmpty) {
  const CommandResult result = vdbmap({"diff", yard_map("a.vdb", false), yard_map("b.vdb", true)});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("knows no rays"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("0 appeared"), std::string::npos) << result.out;
}

TEST_F(DiffCommand, WritesATableOfTheRegions) {
  const std::string a = yard_map("a.vdb", false), b = yard_map("b.vdb", true);
  EXPECT_EQ(vdbmap({"diff", a, b, "--assume-seen", "--csv", path("regions.csv")}).exit_code, 0);
  const std::string text = test::read_raw(path("regions.csv"));
  EXPECT_TRUE(text.starts_with("id,kind,x,y,z,length,width,height,yaw,volume_m3,voxels,label,confidence\n1,appeared,"));
  EXPECT_EQ(num_lines(text), 1 + json_of({"diff", a, b, "--assume-seen"})["regions"].size());
}

TEST_F(DiffCommand, WritesOutlinesOnTheGlobe) {
  const std::string a = yard_map("a.vdb", false, {"--epsg", "25832"}), b = yard_map("b.vdb", true, {"--epsg", "25832"});
  EXPECT_EQ(vdbmap({"diff", a, b, "--assume-seen", "--geojson", path("regions.geojson")}).exit_code, 0);
  std::ifstream file(path("regions.geojson"));
  const json collection = json::parse(file);
  EXPECT_EQ(collection["type"], "FeatureCollection");
  const json& feature = collection["features"][0];
  EXPECT_EQ(feature["properties"]["kind"], "appeared");
  const json& ring = feature["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 5u);
  EXPECT_EQ(ring[0], ring[4]);
  // Hannover; RFC 7946: longitude first, and against the clock.
  EXPECT_NEAR(ring[0][0].get<double>(), 9.7, 0.3);
  EXPECT_NEAR(ring[0][1].get<double>(), 52.4, 0.3);
  double twice_area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto x = [&](std::size_t k) { return ring[k][0].get<double>() - ring[0][0].get<double>(); };
    const auto y = [&](std::size_t k) { return ring[k][1].get<double>() - ring[0][1].get<double>(); };
    twice_area += x(i) * y(i + 1) - x(i + 1) * y(i);
  }
  EXPECT_GT(twice_area, 0);
}

TEST_F(DiffCommand, OutlinesOnTheGlobeNeedTheEpsgCode) {
  const std::string a = yard_map("a.vdb", false), b = yard_map("b.vdb", true);
  expect_error(vdbmap({"diff", a, b, "--assume-seen", "--quiet", "--geojson", path("regions.geojson")}),
               ExitCode::kWrongUsage, "EPSG");
  EXPECT_FALSE(std::filesystem::exists(path("regions.geojson")));
}

TEST_F(DiffCommand, WritesAMapOfTheChangesThatOthersOpenAndThatIsDrawn) {
  const std::string a = yard_map("a.vdb", false), b = yard_map("b.vdb", true), diff = path("diff.vdb");
  EXPECT_EQ(vdbmap({"diff", a, b, "--assume-seen", "-o", diff}).exit_code, 0);
  const CommandResult check = vdbmap({"check", diff});
  EXPECT_EQ(check.exit_code, 0) << check.out;
  for (const char* view : {"plan", "perspective", "orbit"}) {
    const std::string picture = path(std::string(view) + ".png");
    const CommandResult result =
        vdbmap({"render", b, "--diff", diff, "-o", picture, "--view", view, "--size", "320x240"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  // From above the block is green, the ground around it pale.
  const Image plan = test::read_picture(path("plan.png"));
  int num_green = 0, num_pale = 0;
  for (const Rgb8& pixel : plan.pixels()) {
    num_green += pixel.g > pixel.r + 60 ? 1 : 0;
    num_pale += std::abs(pixel.r - pixel.g) < 12 && std::abs(pixel.g - pixel.b) < 12 && pixel.r > 120 ? 1 : 0;
  }
  EXPECT_GT(num_green, 200);
  EXPECT_GT(num_pale, 10 * num_green);
}

TEST_F(DiffCommand, DrawsAPageForPeople) {
  const std::string a = yard_map("a.vdb", false), b = yard_map("b.vdb", true);
  const CommandResult result =
      vdbmap({"diff", a, b, "--assume-seen", "--plot", path("page.png"), "--dates", "2023-03-01", "2024-03-01"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(test::read_picture(path("page.png")).width(), 2400);
}

TEST_F(DiffCommand, AlignsSurveysThatAreShifted) {
  // Ground alone would not hold it: walls on two sides.
  const auto room = [](double shift) {
    PointCloud cloud = scan(3, 60'000);
    for (int i = 0; i < 20'000; ++i) cloud.positions.emplace_back(7.0, (i % 141) * 0.06 - 4, (i / 141) * 0.02);
    cloud.intensities.clear();
    for (Eigen::Vector3d& point : cloud.positions) point.x() += shift;
    return cloud;
  };
  const std::string a = built("a.vdb", moved(room(0), kUtm)), b = built("b.vdb", moved(room(0.1), kUtm));
  const json aligned = json_of({"diff", a, b, "--assume-seen", "--align"});
  EXPECT_NEAR(aligned["alignment"]["shift"][0].get<double>(), -0.1, 0.005);
  EXPECT_LT(aligned["voxels"]["changed"].get<int>(), 50);
  EXPECT_GT(json_of({"diff", a, b, "--assume-seen"})["voxels"]["changed"].get<int>(), 500);
}

TEST_F(DiffCommand, OfCitiesIsThatOfTheFiles) {
  const std::string a = yard_map("a.vdb", false, {"--anchor", "548864,5804032,0"});
  const std::string b = yard_map("b.vdb", true, {"--anchor", "548864,5804032,0"});
  EXPECT_EQ(vdbmap({"export", a, path("city_a/")}).exit_code, 0);
  EXPECT_EQ(vdbmap({"export", b, path("city_b/")}).exit_code, 0);
  const json of_files = json_of({"diff", a, b, "--assume-seen"});
  EXPECT_EQ(json_of({"diff", path("city_a"), path("city_b"), "--assume-seen"}), of_files);
  EXPECT_EQ(json_of({"diff", path("city_a"), b, "--assume-seen"}), of_files);
  const json none = json_of({"diff", path("city_a"), path("city_a")});
  EXPECT_EQ(none["voxels"]["unchanged"], json_of({"diff", a, a, "--assume-seen"})["voxels"]["unchanged"]);
  EXPECT_EQ(none["voxels"]["unobserved"], 0);
}

TEST_F(DiffCommand, RefusesWhatCannotBeCompared) {
  const std::string a = yard_map("a.vdb", false, {"--epsg", "25832"});
  expect_error(vdbmap({"diff", a, yard_map("b.vdb", false, {"--epsg", "25833"})}), ExitCode::kWrongUsage, "EPSG:25833");
  expect_error(vdbmap({"diff", a, yard_map("c.vdb", false, {"--levels", "0.2,1"})}), ExitCode::kWrongUsage,
               "voxels of 0.1 m and of 0.2 m");
  expect_error(vdbmap({"diff", a, path("missing.vdb")}), ExitCode::kInputOutputFailed, "missing.vdb");
  expect_error(vdbmap({"diff", a, a, "-o", a}), ExitCode::kWrongUsage, "a.vdb");
  expect_error(vdbmap({"diff", a, a, "--significance", "2"}), ExitCode::kWrongUsage, "significance");
  expect_error(vdbmap({"diff", a, a, "--csv", path("no/such/folder.csv")}), ExitCode::kInputOutputFailed, "folder.csv");
  expect_error(vdbmap({"render", a, "--diff", a, "-o", path("x.png")}), ExitCode::kBadInput, "no diff");
  expect_error(vdbmap({"render", a, "--color-by", "change", "-o", path("x.png")}), ExitCode::kWrongUsage, "--diff");
  expect_error(vdbmap({"render", a, "--color-by", "age", "-o", path("x.png")}), ExitCode::kWrongUsage, "epochs");
}

TEST_F(DiffCommand, SaysThatMapsDoNotOverlap) {
  const std::string a = yard_map("a.vdb", false);
  const std::string b = built("far.vdb", moved(yard(false), kUtm + Eigen::Vector3d(500, 0, 0)));
  const CommandResult result = vdbmap({"diff", a, b, "--exit-code"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("do not overlap"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace vdbmap::cli
