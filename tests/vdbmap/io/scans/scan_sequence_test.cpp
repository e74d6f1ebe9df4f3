// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scans/scan_sequence.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/vlp16_packets.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/velodyne/vlp16_pcap.h"

namespace vdbmap {
namespace {

using test::write_raw;

class ScanSequence : public testing::Test {
 protected:
  // 2.65 turns from 270 degrees on: the end of one, two whole and the start of another.
  std::filesystem::path capture(const std::string& name) const {
    const test::Vlp16Recording recording{.num_packets = 200, .start_azimuth_deg = 270};
    return write_raw(folder_ / name, test::ethernet_capture(test::vlp16_payloads({}, recording)));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ScanSequence, AFileIsOneScanAndACaptureOneATurn) {
  const std::filesystem::path text = write_raw(folder_ / "a.xyz", "1 2 3\n");
  const std::filesystem::path turns = capture("b.pcap");
  const std::vector<ScanPlace> scans = list_scans({text, turns, text});

  EXPECT_EQ(scans, (std::vector<ScanPlace>{{text, {}}, {turns, 0}, {turns, 1}, {turns, 2}, {turns, 3}, {text, {}}}));
  EXPECT_EQ(scans[0].name(), text.string());
  EXPECT_EQ(scans[1].name(), turns.string() + ", turn 1");
}

TEST_F(ScanSequence, ScansAreReadInAnyOrder) {
  const std::filesystem::path a = capture("a.pcap");
  const std::filesystem::path b = capture("b.pcap");
  const std::vector<PointCloud> expected = read_vlp16_scans(a);
  ScanReader reader;
  for (const ScanPlace& scan : std::vector<ScanPlace>{{a, 0}, {a, 1}, {a, 3}, {a, 3}, {a, 2}, {b, 2}, {a, 3}, {b, 0}}) {
    const PointCloud cloud = reader.read(scan).cloud;
    EXPECT_EQ(cloud.positions, expected[*scan.turn].positions) << scan.name();
    EXPECT_EQ(cloud.times, expected[*scan.turn].times) << scan.name();
  }
}

TEST_F(ScanSequence, TheTurnsTogetherAreTheCapture) {
  const std::filesystem::path path = capture("a.pcap");
  std::vector<Eigen::Vector3d> positions;
  ScanReader reader;
  for (const ScanPlace& scan : list_scans({path})) {
    const PointCloud cloud = reader.read(scan).cloud;
    positions.insert(positions.end(), cloud.positions.begin(), cloud.positions.end());
  }
  EXPECT_EQ(positions, read_points(path).cloud.positions);
}

TEST_F(ScanSequence, WholeFilesSayWhatTheyHeld) {
  const ReadResult read = ScanReader().read({write_raw(folder_ / "a.xyz", "1 2 3\nnan 2 3\n"), std::nullopt});
  EXPECT_EQ(read.cloud.size(), 1U);
  EXPECT_EQ(read.dropped.size(), 1U);
}

TEST_F(ScanSequence, ATurnBeyondTheCaptureIsAnErrorThatCountsThem) {
  const std::filesystem::path path = capture("a.pcap");
  EXPECT_EQ(test::io_error_of([&] { ScanReader().read({path, 4}); }), "a.pcap: has no turn 5, only 4");
}

// What reading all the turns of a capture says, place by place.
std::vector<std::string> findings_of_turns(const std::filesystem::path& path) {
  std::vector<std::string> texts;
  ScanReader reader;
  for (const ScanPlace& scan : list_scans({path})) {
    for (const ReadFinding& finding : reader.read(scan).findings) {
      texts.push_back(std::to_string(*scan.turn + 1) + ": " + finding.text());
    }
  }
  return texts;
}

TEST_F(ScanSequence, ACaptureThatIsCutOffHasTheTurnsBefore) {
  const std::filesystem::path path = capture("a.pcap");
  const std::size_t num_points = read_points(path).cloud.size();
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);

  ASSERT_EQ(list_scans({path}).size(), 4U);
  std::size_t num_points_left = 0;
  ScanReader reader;
  for (const ScanPlace& scan : list_scans({path})) num_points_left += reader.read(scan).cloud.size();
  EXPECT_EQ(num_points_left, num_points - 384);
  ASSERT_EQ(findings_of_turns(path).size(), 1U);
  EXPECT_TRUE(findings_of_turns(path)[0].starts_with(
      "4: the capture is cut off or damaged, its rest is left out (packet 200: "));
}

TEST_F(ScanSequence, WhatIsFoundInACaptureIsSaidOnceWithTheTurnAfterIt) {
  const test::Vlp16Recording recording{.num_packets = 200, .start_azimuth_deg = 270};
  std::vector<std::string> payloads = test::vlp16_payloads({}, recording);
  for (const std::size_t damaged : {60, 61, 150}) payloads[damaged][100] = '\0';
  std::vector<std::string> frames;
  for (const std::string& payload : payloads) frames.push_back(test::link_frame(1, test::ipv4_udp_packet(payload)));
  frames.push_back(test::link_frame(1, test::ipv4_udp_packet(payloads[0], 2368, 7)));
  const std::filesystem::path path = write_raw(folder_ / "a.pcap", test::pcap_file(1, frames));

  EXPECT_EQ(
      findings_of_turns(path),
      (std::vector<std::string>{
          "1: a second sensor at 192.168.1.7:2368 is left out: --sensor 192.168.1.7:2368 chooses it (VLP-16, 1 data "
          "packets)",
          "2: 2 damaged data packets left out (first: packet 61: data block 1 lacks its flag)",
          "3: 1 damaged data packets left out (packet 151: data block 1 lacks its flag)"}));
  const ReadOptions strict{.strict = true};
  EXPECT_EQ(list_scans({path}, strict), (std::vector<ScanPlace>{{path, {}}}));
  EXPECT_EQ(test::io_error_of([&] {
              ScanReader(strict).read({path, {}});
            }),
            "a.pcap: 3 damaged data packets left out (first: packet 61: data block 1 lacks its flag)");
}

TEST_F(ScanSequence, ACaptureOfNoPointsIsOneScanThatCannotBeRead) {
  const std::filesystem::path good = capture("a.pcap");
  const std::filesystem::path bad = write_raw(folder_ / "b.pcap", test::pcap_file(1, {}));
  const std::vector<ScanPlace> scans = list_scans({bad, good});
  EXPECT_EQ(scans.size(), 5U);
  EXPECT_EQ(test::io_error_of([&] { ScanReader().read(scans[0]); }),
            "b.pcap: holds no points: no returns in Velodyne data packets among 0 packets");
  EXPECT_THROW(list_scans({folder_ / "none.pcap"}), IoError);
}

TEST_F(ScanSequence, AChosenSensorNeedsACapture) {
  ReadOptions options;
  options.sensor = parse_sensor_choice("192.168.1.201");
  const std::filesystem::path path = capture("a.pcap");
  EXPECT_EQ(list_scans({path}, options).size(), 4U);
  options.sensor = parse_sensor_choice("192.168.1.7");
  EXPECT_EQ(test::io_error_of([&] { list_scans({path}, options); }),
            "a.pcap: no sensor at 192.168.1.7, only 192.168.1.201:2368");
  EXPECT_THROW(list_scans({write_raw(folder_ / "a.xyz", "1 2 3\n")}, options), std::invalid_argument);
}

TEST_F(ScanSequence, RecordedCapturesGiveTurnsOfAboutATenthOfASecond) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  ScanReader reader;
  for (const char* name : {"hdl32.pcap", "vlp16_bench.pcap"}) {
    for (const ScanPlace& scan : list_scans({*data / "velodyne" / name})) {
      const PointCloud cloud = reader.read(scan).cloud;
      EXPECT_LT(cloud.times.back() - cloud.times.front(), 0.12) << scan.name();  // they turned at 9 to 10 Hz
    }
  }
}

}  // namespace
}  // namespace vdbmap
