// SPDX-License-Identifier: GPL-3.0-or-later
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/http_request.h"
#include "tests/support/raw_files.h"
#include "tests/tools/map_command.h"
#include "tools/cli/site_server.h"

namespace vdbmap::cli {
namespace {

class WebCommand : public MapCommand {
 protected:
  std::string street() const { return built("map.vdb", moved(scan(1), kUtm), {"--epsg", "25832"}); }

  nlohmann::json site(const std::string& name) const {
    return nlohmann::json::parse(test::read_raw(path(name + "/site.json")));
  }
};

TEST_F(WebCommand, WritesASite) {
  const nlohmann::json result = json_of({"web", street(), "-o", path("site")});
  EXPECT_EQ(result["voxels"], json_of({"info", path("map.vdb")})["levels"][0]["voxels"]);
  EXPECT_EQ(result["on_globe"], true);
  EXPECT_EQ(site("site")["name"], "map");
  EXPECT_EQ(site("site")["epochs"][0]["name"], "map");
  EXPECT_TRUE(std::filesystem::exists(path("site/tileset_1.json")));
  EXPECT_EQ(json_of({"web", path("map.vdb"), "-o", path("site")})["files_written"], 0) << "nothing is new";
}

TEST_F(WebCommand, GivesEpochsTheirNames) {
  const std::string map = street();
  ASSERT_EQ(vdbmap({"export", map, path("city/")}).exit_code, 0);
  ASSERT_EQ(
      vdbmap({"build", ply("later.ply", moved(scan(2), kUtm)), "--into", path("city/"), "--epoch", "2"}).exit_code, 0);
  json_of({"web", path("city/"), "-o", path("site"), "--epoch-names", "2023-03,2023-09-05", "--name", "The street"});
  const nlohmann::json written = site("site");
  EXPECT_EQ(written["name"], "The street");
  ASSERT_EQ(written["epochs"].size(), 2U);
  EXPECT_EQ(written["epochs"][0]["date"], "2023-03-01");
  EXPECT_EQ(written["epochs"][1]["date"], "2023-09-05");
  EXPECT_LT(written["epochs"][0]["points"].get<int>(), written["epochs"][1]["points"].get<int>());
  json_of({"web", path("city@2"), "-o", path("one")});
  EXPECT_EQ(site("one")["epochs"].size(), 1U);
  EXPECT_EQ(site("one")["epochs"][0]["name"], "epoch 2");
}

TEST_F(WebCommand, RefusesWhatItCannotDo) {
  const std::string map = street();
  expect_error(vdbmap({"web", map}), ExitCode::kWrongUsage, "nothing to do");
  expect_error(vdbmap({"web", map, "-o", path("site"), "--open"}), ExitCode::kWrongUsage, "--serve");
  expect_error(vdbmap({"web", map, "-o", path("site"), "--epoch-names", "a,b"}), ExitCode::kWrongUsage,
               "2 names for 1");
  expect_error(vdbmap({"web", path("none.vdb"), "-o", path("site")}), ExitCode::kInputOutputFailed, "none.vdb");
  expect_error(vdbmap({"web", ply("a.ply", scan(1)), "-o", path("site")}), ExitCode::kBadInput, "a.ply");
  expect_error(vdbmap({"web", map, "-o", map}), ExitCode::kInputOutputFailed, "map.vdb");
  expect_error(vdbmap({"web", map, "-o", path("none/site")}), ExitCode::kInputOutputFailed, "none/site");
  std::filesystem::create_directory(path("mine"));
  std::ofstream(path("mine/letter.txt")) << "dear";
  expect_error(vdbmap({"web", map, "-o", path("mine")}), ExitCode::kBadInput, "holds something else");
  expect_error(vdbmap({"web", map, map, built("other.vdb", scan(1)), "-o", path("site")}), ExitCode::kWrongUsage,
               "another anchor");
  EXPECT_FALSE(std::filesystem::exists(path("site")));
  EXPECT_EQ(test::read_raw(path("mine/letter.txt")), "dear");
}

TEST_F(WebCommand, SaysThatAMapWithoutEpsgCodeIsLocal) {
  const test::CommandResult result = vdbmap({"web", built("map.vdb", scan(1)), "-o", path("site")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("local coordinates"), std::string::npos);
}

TEST_F(WebCommand, ServesUntilItIsInterrupted) {
  // A port that was free a moment ago.
  const int port = SiteServer(folder_.path(), {"127.0.0.1", 0}).port();
  json_of({"web", street(), "-o", path("site")});
  test::RunOptions options;
  test::HttpAnswer answer;
  options.while_running = [&](pid_t child) {
    for (int attempt = 0; attempt < 600 && answer.status == 0; ++attempt) {
      ::usleep(50'000);
      answer = test::http_request(port, "/site.json");
    }
    ::kill(child, SIGINT);
  };
  const test::CommandResult result =
      test::run_command(VDBMAP_COMMAND, {"web", path("site"), "--serve", "--port", std::to_string(port)}, options);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "http://127.0.0.1:" + std::to_string(port) + "/ (Ctrl-C ends it)\n");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, test::read_raw(path("site/site.json")));
}

TEST_F(WebCommand, RefusesAPortThatIsTakenAndLeavesNothing) {
  const SiteServer other(folder_.path(), {"127.0.0.1", 0});
  const std::string map = street();
  const auto entries = [] {
    std::set<std::filesystem::path> names;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path())) {
      if (entry.path().filename().string().starts_with("vdbmap-site")) names.insert(entry.path());
    }
    return names;
  };
  const auto before = entries();
  const test::CommandResult result = vdbmap({"web", map, "--serve", "--port", std::to_string(other.port())});
  EXPECT_EQ(result.exit_code, static_cast<int>(ExitCode::kInputOutputFailed));
  EXPECT_NE(result.err.find("Address already in use"), std::string::npos) << result.err;
  EXPECT_EQ(entries(), before);
}

}  // namespace
}  // namespace vdbmap::cli
