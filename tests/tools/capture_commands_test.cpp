// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/raw_files.h"
#include "tests/support/vlp16_packets.h"
#include "tests/tools/map_command.h"
#include "vdbmap/io/poses/trajectory_file.h"
#include "vdbmap/io/velodyne/vlp16_pcap.h"

namespace vdbmap::cli {
namespace {

using nlohmann::json;

// A capture of 2.65 turns that are cut into four: the end of one, two whole and the start of another.
class Capture : public MapCommand {
 protected:
  std::string capture() const {
    const test::Vlp16Recording recording{.num_packets = 200, .start_azimuth_deg = 270};
    return test::write_raw(folder_ / "room.pcap", test::ethernet_capture(test::vlp16_payloads({}, recording)));
  }

  // Pose number i stands at x = 0.1 i.
  std::string poses(std::size_t count) const {
    Trajectory trajectory;
    for (std::size_t i = 0; i < count; ++i) {
      trajectory.map_from_scan.emplace_back(Eigen::Translation3d(0.1 * static_cast<double>(i), 0, 0));
    }
    write_trajectory(path("poses.txt"), trajectory, TrajectoryFormat::kKitti);
    return path("poses.txt");
  }
};

TEST_F(Capture, BuildGivesEachTurnItsPose) {
  const std::string room = capture();
  build({room}, "posed.vdb", {"--poses", poses(4), "--every", "2", "--offset", "1"});

  const std::vector<PointCloud> turns = read_vlp16_scans(room);
  build({ply("1.ply", moved(turns[1], {0.1, 0, 0})), ply("3.ply", moved(turns[3], {0.3, 0, 0}))}, "moved.vdb");
  expect_same_bytes("posed.vdb", "moved.vdb");
}

TEST_F(Capture, BuildCountsTurnsAndFiles) {
  const json built = json_of({"build", capture(), "--poses", poses(4), "-o", path("map.vdb")});
  EXPECT_EQ(built["files"], 1);
  EXPECT_EQ(built["scans"], 4);
}

TEST_F(Capture, FewerPosesThanTurnsAreBadInput) {
  expect_error(vdbmap({"build", capture(), "--poses", poses(3), "-o", path("map.vdb")}), ExitCode::kBadInput,
               "3 poses for 4 scans");
}

TEST_F(Capture, OneThatIsCutOffOrCannotBeReadDoesNotStopTheOthers) {
  std::filesystem::create_directory(folder_ / "captures");
  const std::string whole = test::read_raw(capture());
  test::write_raw(folder_ / "captures" / "1.pcap", whole.substr(0, whole.size() - 100));
  test::write_raw(folder_ / "captures" / "2.pcap", whole.substr(0, 100));
  test::write_raw(folder_ / "captures" / "3.pcap", whole);
  test::write_raw(folder_ / "captures" / "poses.csv", "1 2 3\n");
  const test::CommandResult run = vdbmap({"odometry", path("captures"), "-o", path("o.txt"), "--json"});
  EXPECT_EQ(json::parse(run.out)["scans"], 4 + 1 + 4) << run.err;
  EXPECT_NE(run.err.find("1.pcap: the capture is cut off or damaged, its rest is left out"), std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("2.pcap: no pose: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("captures: 1 text files that are no scans left out (poses.csv "), std::string::npos)
      << run.err;
}

TEST_F(Capture, StrictReadingRefusesOneThatIsCutOff) {
  const std::string room = capture();
  std::filesystem::resize_file(room, std::filesystem::file_size(room) - 1);
  const std::string part = "room.pcap: the capture is cut off or damaged, its rest is left out (packet 200: ";
  expect_error(vdbmap({"odometry", room, "--strict", "-o", path("o.txt")}), ExitCode::kBadInput, part);
  expect_error(vdbmap({"build", room, "--strict", "-o", path("map.vdb")}), ExitCode::kBadInput, part);
}

TEST_F(Capture, ASensorIsChosenByItsAddress) {
  const std::string room = capture();
  EXPECT_EQ(json_of({"build", room, "--sensor", "192.168.1.201:2368", "-o", path("map.vdb")})["scans"], 4);
  expect_error(vdbmap({"build", room, "--sensor", "192.168.1.202", "-o", path("map.vdb")}), ExitCode::kBadInput,
               "room.pcap: no sensor at 192.168.1.202, only 192.168.1.201:2368");
}

TEST_F(Capture, WithoutPosesItsPointsAreOneCloud) {
  const std::string room = capture();
  build({room}, "a.vdb");
  build({ply("room.ply", read_points(room).cloud)}, "b.vdb");
  expect_same_bytes("a.vdb", "b.vdb");
}

TEST_F(Capture, LocalizeAnswersForEachChosenTurn) {
  const std::string room = capture();
  build({room}, "map.vdb");
  // The bare round wall determines no pose; what counts is which scans the answers are for.
  const test::CommandResult run = vdbmap(
      {"localize", path("map.vdb"), room, "--every", "2", "--initial", poses(1), "-o", path("found.txt"), "--json"});
  const json result = json::parse(run.out);
  ASSERT_EQ(result["scans"], 2) << run.err;
  for (const int i : {0, 1}) {
    EXPECT_EQ(result["results"][i]["file"], room);
    EXPECT_EQ(result["results"][i]["turn"], 2 * i + 1);
  }
  EXPECT_NE(run.err.find("room.pcap, turn 3: "), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vdbmap::cli
