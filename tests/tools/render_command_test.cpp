// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/picture.h"
#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap::cli {
namespace {

using test::CommandResult;

class Render : public MapCommand {
 protected:
  std::string map() const { return built("map.vdb", scan(1)); }

  std::string poses() const {
    Trajectory trajectory;
    for (int i = 0; i < 10; ++i) {
      trajectory.map_from_scan.emplace_back(Eigen::Translation3d(i - 5, 0, 1.7) * Eigen::Isometry3d::Identity());
    }
    write_trajectory(path("poses.txt"), trajectory, TrajectoryFormat::kKitti);
    return path("poses.txt");
  }
};

TEST_F(Render, DrawsEveryView) {
  const std::string file = map();
  for (const std::string view : {"plan", "perspective", "orbit"}) {
    const CommandResult result =
        vdbmap({"render", file, "-o", path(view + ".png"), "--view", view, "--size", "320x200"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Image image = test::read_picture(path(view + ".png"));
    EXPECT_EQ(image.width(), 320);
    EXPECT_EQ(image.height(), 200);
  }
  EXPECT_NE(test::read_raw(path("plan.png")), test::read_raw(path("orbit.png")));
}

TEST_F(Render, IsFullHdByDefault) {
  const nlohmann::json report = json_of({"render", map(), "-o", path("map.png")});
  EXPECT_EQ(report["width"], 1920);
  EXPECT_EQ(report["height"], 1080);
  EXPECT_GT(report["voxels"], 100);
  EXPECT_EQ(report["camera_in_voxel"], false);
}

TEST_F(Render, DrawsTrajectoriesAndPointsOverTheMap) {
  const std::string file = map();
  const CommandResult result = vdbmap({"render", file, "-o", path("plan.png"), "--view", "plan", "--size", "640x400",
                                       "--trajectory", poses(), "--points", path("map.vdb.ply")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(test::count_pixels(test::read_picture(path("plan.png")), rgb8(0xe3241f)), 100U);
}

TEST_F(Render, FilesOfOneNameAreToldApartInTheLegend) {
  const std::string file = map();
  std::filesystem::create_directories(folder_ / "a_long_name_of_a_folder");
  std::filesystem::copy_file(poses(), folder_ / "a_long_name_of_a_folder" / "poses.txt");
  const auto picture = [&](const std::string& second) {
    const CommandResult result = vdbmap({"render", file, "-o", path("plan.png"), "--view", "plan", "--size", "640x400",
                                         "--trajectory", path("poses.txt"), path(second)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return test::read_raw(path("plan.png"));
  };
  std::filesystem::copy_file(path("poses.txt"), path("other.txt"));
  EXPECT_NE(picture("a_long_name_of_a_folder/poses.txt"), picture("other.txt"));
}

TEST_F(Render, AnyNumberOfThreadsWritesTheSameBytes) {
  const std::string file = map();
  for (const std::string threads : {"1", "3"}) {
    vdbmap({"render", file, "-o", path(threads + ".png"), "--size", "400x300", "--threads", threads});
  }
  EXPECT_EQ(test::read_raw(path("1.png")), test::read_raw(path("3.png")));
}

TEST_F(Render, WrongUsageIsToldInOneLine) {
  const std::string file = map();
  const std::string out = path("map.png");
  for (const std::string size : {"0x100", "100x0", "100000x100000", "100", "x", "-5x5", "1e3x5", "100x100x3"}) {
    expect_error(vdbmap({"render", file, "-o", out, "--size", size}), ExitCode::kWrongUsage, "--size");
  }
  expect_error(vdbmap({"render", file, "-o", out, "--view", "sideways"}), ExitCode::kWrongUsage, "--view");
  expect_error(vdbmap({"render", file, "-o", out, "--color-by", "taste"}), ExitCode::kWrongUsage, "--color-by");
  expect_error(vdbmap({"render", file, "-o", out, "--color-by", "rgb"}), ExitCode::kWrongUsage, "no colours");
  expect_error(vdbmap({"render", file, "-o", out, "--color-by", "label"}), ExitCode::kWrongUsage, "no labels");
  expect_error(vdbmap({"render", file, "-o", out, "--camera", "1"}), ExitCode::kWrongUsage, "HEADING,ELEVATION");
  expect_error(vdbmap({"render", file, "-o", out, "--camera", "x,y"}), ExitCode::kWrongUsage, "--camera");
  expect_error(vdbmap({"render", file, "-o", out, "--level", "0.3"}), ExitCode::kWrongUsage, "0.300 m");
  expect_error(vdbmap({"render", file, "-o", file}), ExitCode::kWrongUsage, "is an input too");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Render, FilesThatCannotBeUsedHaveTheirOwnCodes) {
  const std::string file = map();
  test::write_raw(folder_ / "text.vdb", "text");
  expect_error(vdbmap({"render", path("text.vdb"), "-o", path("a.png")}), ExitCode::kBadInput, "text.vdb");
  expect_error(vdbmap({"render", path("none.vdb"), "-o", path("a.png")}), ExitCode::kInputOutputFailed, "none.vdb");
  expect_error(vdbmap({"render", file, "-o", path("no/folder.png")}), ExitCode::kInputOutputFailed, "no/folder.png");
  expect_error(vdbmap({"render", file, "-o", path("a.png"), "--trajectory", path("none.txt")}),
               ExitCode::kInputOutputFailed, "none.txt");
}

TEST_F(Render, AMapWithoutVoxelsIsBadInput) {
  VoxelMap empty;
  empty.levels.emplace_back(0.1, LargeVector<VoxelLeaf>{}, LargeVector<VoxelRecord>{});
  empty.levels.emplace_back(1.0, LargeVector<VoxelLeaf>{}, LargeVector<VoxelRecord>{});
  save_map(path("empty.vdb"), empty);
  expect_error(vdbmap({"render", path("empty.vdb"), "-o", path("a.png")}), ExitCode::kBadInput, "empty.vdb");
}

TEST_F(Render, ACameraInAVoxelIsSaidAndItsPictureDrawn) {
  const std::string file = built("dot.vdb", points({{0.55, 0.55, 0.55}, {3.05, 0.55, 0.55}}));
  const CommandResult result = vdbmap({"render", file, "-o", path("dot.png"), "--view", "perspective", "--size",
                                       "64x48", "--camera", "0.55,0.55,0.55,0,0"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("inside of a voxel"), std::string::npos) << result.err;
  EXPECT_TRUE(std::filesystem::exists(path("dot.png")));
}

}  // namespace
}  // namespace vdbmap::cli
