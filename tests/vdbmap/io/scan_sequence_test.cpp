// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scan_sequence.h"

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/vlp16_packets.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/vlp16_pcap.h"

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

TEST_F(ScanSequence, DamageInACaptureShowsWhenItsTurnsAreCounted) {
  const std::filesystem::path path = capture("a.pcap");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_THROW(list_scans({path}), IoError);
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
