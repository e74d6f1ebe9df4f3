// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "tools/cli/output_ending.h"
#include "vdbmap/io/vdb/vdb_file.h"

namespace vdbmap::cli {
namespace {

namespace fs = std::filesystem;

using test::CommandResult;
using test::read_raw;

bool is_accepted(const std::string& name, const OutputKind& kind) {
  try {
    check_ending(name, kind);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

TEST(OutputEnding, OfTheFormatThatIsWrittenIsAccepted) {
  EXPECT_TRUE(is_accepted("map.vdb", kMapKind));
  EXPECT_TRUE(is_accepted("MAP.VDB", kMapKind));
  EXPECT_TRUE(is_accepted("plan.png", kPictureKind));
  EXPECT_TRUE(is_accepted("poses.txt", kPosesKind));
  EXPECT_TRUE(is_accepted("report.json", kJsonKind));
}

TEST(OutputEnding, ThatStandsForNoFormatIsAccepted) {
  for (const OutputKind& kind : {kMapKind, kPictureKind, kPosesKind, kJsonKind}) {
    for (const std::string name : {"map", "map.old", "v1.2", ".hidden", "poses.tum", "poses.kitti", "2024.05.17"}) {
      EXPECT_TRUE(is_accepted(name, kind)) << name << " as " << kind.name;
    }
  }
}

TEST(OutputEnding, OfAnotherFormatIsRefused) {
  for (const std::string name : {"p.jp2", "p.WEBP", "p.tif", "p.vdb", "p.pdf", "p.svg"}) {
    EXPECT_FALSE(is_accepted(name, kPictureKind)) << name;
  }
  for (const std::string name : {"m.las", "m.ply", "m.png", "m.xyz", "m.vdb.gz", "m.nvdb", "m.json", "m.txt"}) {
    EXPECT_FALSE(is_accepted(name, kMapKind)) << name;
  }
  for (const std::string name : {"p.vdb", "p.csv", "p.json", "p.png"})
    EXPECT_FALSE(is_accepted(name, kPosesKind)) << name;
  for (const std::string name : {"r.vdb", "r.png", "r.csv", "r.yaml"})
    EXPECT_FALSE(is_accepted(name, kJsonKind)) << name;
}

class Output : public MapCommand {
 protected:
  std::size_t num_files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }
};

TEST_F(Output, IsRefusedInOneLineWhereItsNameStandsForAnotherFormat) {
  const std::string map = built("map.vdb", points({{1, 2, 3}}));
  const std::size_t before = num_files();
  expect_error(vdbmap({"render", map, "-o", path("p.tif")}), ExitCode::kWrongUsage,
               "p.tif: is written as a PNG or JPEG picture, but '.tif' stands for another format: choose a name with "
               ".png");
  expect_error(vdbmap({"build", path("map.vdb.ply"), "-o", path("m.las")}), ExitCode::kWrongUsage, "an OpenVDB file");
  expect_error(vdbmap({"export", map, "--channels", path("c.ply")}), ExitCode::kWrongUsage, "an OpenVDB file");
  EXPECT_EQ(num_files(), before);
}

TEST_F(Output, GoesWhereALinkPoints) {
  fs::create_directory(folder_ / "disk");
  fs::create_symlink("disk/map.vdb", folder_ / "link.vdb");
  built("link.vdb", points({{1, 2, 3}}));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.vdb"));
  EXPECT_TRUE(read_raw(folder_ / "disk" / "map.vdb").starts_with(" BDV"));
}

TEST_F(Output, LeavesNothingBehindBeyondTheLimitOfFileSizes) {
  const std::string cloud = ply("cloud.ply", scan(1));
  const CommandResult result = test::run_command(
      "/bin/sh", {"-c", "ulimit -f 8; exec \"$0\" \"$@\"", VDBMAP_COMMAND, "build", cloud, "-o", path("map.vdb")});
  EXPECT_EQ(result.signal, 0);
  EXPECT_EQ(result.exit_code, static_cast<int>(ExitCode::kInputOutputFailed));
  EXPECT_NE(result.err.find("map.vdb: cannot write"), std::string::npos) << result.err;
  EXPECT_EQ(num_files(), 1u);
}

// A title that a terminal obeys, as colours or as a second line that we did not write.
TEST_F(Output, ShowsNoControlCharactersOfFiles) {
  const std::string evil = "x\x1b[31m\u009b1m\x7f\npassed  known_point";
  const auto grid = openvdb::FloatGrid::create();
  grid->setName(evil);
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(evil));
  metadata.insertMeta(evil, openvdb::StringMetadata("y"));
  const std::string file = path("evil\x1b[2J\n.vdb");
  write_vdb(file, {grid}, metadata);

  const auto is_clean = [](const std::string& text) {
    return text.find('\x1b') == std::string::npos && text.find('\x7f') == std::string::npos &&
           text.find("\xc2\x9b") == std::string::npos && text.find("\npassed  known_point") == std::string::npos;
  };
  for (const std::string command : {"info", "check"}) {
    const CommandResult text = vdbmap({command, file});
    EXPECT_TRUE(is_clean(text.out)) << text.out;
    const CommandResult told = vdbmap({command, file, "--json"});
    EXPECT_TRUE(is_clean(told.out)) << told.out;
    EXPECT_EQ(nlohmann::json::parse(told.out)["file"], file);
  }
  const CommandResult error = vdbmap({"query", file, "--at", "0,0,0"});
  EXPECT_TRUE(is_clean(error.err)) << error.err;
  EXPECT_EQ(num_lines(error.err), 1u);
}

TEST_F(Output, PipesAreNoInputAndSaidSo) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string command : {"info", "check"}) {
    expect_error(vdbmap({command, path("pipe")}), ExitCode::kBadInput, "pipe: not a regular file");
  }
  expect_error(vdbmap({"build", path("pipe"), "-o", path("m.vdb")}), ExitCode::kBadInput, "pipe: not a regular file");
}

TEST_F(Output, CoordinatesHaveTheDigitsOfThePoints) {
  const std::string map = built("map.vdb", points({{389012.1, 5804032.7, 61.3}}));
  const auto voxels = json_of({"query", map, "--box", "389012,5804032,61,389013,5804033,62"});
  ASSERT_EQ(voxels.size(), 1u);
  EXPECT_EQ(voxels[0]["mean"].dump(), "[389012.1,5804032.7,61.3]");
  EXPECT_EQ(json_of({"info", map})["extent"].dump(),
            R"({"max":[389012.2,5804032.8,61.4],"min":[389012.1,5804032.7,61.3]})");
  EXPECT_EQ(vdbmap({"export", map, path("map.xyz"), "--quiet"}).exit_code, 0);
  EXPECT_EQ(read_raw(path("map.xyz")), "# x y z\n389012.1 5804032.7 61.3\n");
}

}  // namespace
}  // namespace vdbmap::cli
