// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/velodyne/vlp16_pcap.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "tests/support/vlp16_packets.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/velodyne/velodyne_packet.h"

namespace vdbmap {
namespace {

using test::Vlp16Recording;

// [m] Distances are rounded to 2 mm, azimuths of blocks and their steps to 0.01 degrees, which is 2 mm at 11 m.
constexpr double kPositionTolerance = 0.004;
constexpr double kTimeTolerance = 1e-6;  // [s] timestamps are rounded to microseconds

class Vlp16Pcap : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& bytes) const {
    std::filesystem::remove(path_);  // some file systems flush what overwrites a file
    std::ofstream(path_, std::ios::binary) << bytes;
    return path_;
  }

  PointCloud read_room(const Vlp16Recording& recording) const {
    return read_vlp16_pcap(write(test::ethernet_capture(test::vlp16_payloads(room_, recording)))).cloud;
  }

  std::string error_for(const std::string& bytes) const {
    try {
      read_vlp16_pcap(write(bytes));
    } catch (const IoError& error) {
      return error.what();
    }
    return "no error";
  }

  Eigen::Vector3d point_on_wall(const Vlp16Recording& recording, double time, int ring, double share = 1) const {
    const double azimuth = recording.azimuth_at(time);
    const double horizontal = share * room_.horizontal_distance(azimuth);
    return {horizontal * std::cos(azimuth), -horizontal * std::sin(azimuth),
            horizontal * std::tan(test::vlp16_elevation(ring)) + test::vlp16_vertical_offset(ring)};
  }

  test::RoundRoom room_;
  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "room.pcap";
};

TEST_F(Vlp16Pcap, PointsLieOnTheWallWhereTheirTimeAndRingSay) {
  const Vlp16Recording recording{.num_packets = 100, .start_azimuth_deg = 300, .start_us = 12'345'678};
  const PointCloud cloud = read_room(recording);

  ASSERT_EQ(cloud.size(), 100U * 384U);
  ASSERT_EQ(cloud.times.size(), cloud.size());
  ASSERT_EQ(cloud.rings.size(), cloud.size());
  ASSERT_EQ(cloud.intensities.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d expected = point_on_wall(recording, cloud.times[i] - 12.345678, cloud.rings[i]);
    ASSERT_LT((cloud.positions[i] - expected).norm(), kPositionTolerance) << "point " << i;
    ASSERT_EQ(cloud.intensities[i], test::vlp16_intensity(cloud.rings[i]));
  }
}

TEST_F(Vlp16Pcap, TimesFollowTheFiringSequence) {
  const PointCloud cloud = read_room({.num_packets = 3});

  ASSERT_EQ(cloud.size(), 3U * 384U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double expected = static_cast<double>(i / 16) * 55.296e-6 + static_cast<double>(i % 16) * 2.304e-6;
    ASSERT_NEAR(cloud.times[i], expected, kTimeTolerance) << "point " << i;
  }
}

TEST_F(Vlp16Pcap, AzimuthZeroIsForwardAndTurnsClockwise) {
  room_.center.setZero();
  const PointCloud cloud = read_room({.num_packets = 20});  // 95 degrees

  EXPECT_GT(cloud.positions.front().x(), 7.9);
  EXPECT_NEAR(cloud.positions.front().y(), 0, 0.01);
  EXPECT_LT(cloud.positions.back().y(), -7.9);
}

TEST_F(Vlp16Pcap, RingsCountFromTheLowestLaser) {
  const PointCloud cloud = read_room({});

  const std::vector<std::uint16_t> first_firing(cloud.rings.begin(), cloud.rings.begin() + 16);
  EXPECT_EQ(first_firing, (std::vector<std::uint16_t>{0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15}));
}

TEST_F(Vlp16Pcap, PuckHiResHasElevationsOfItsOwn) {
  const PointCloud cloud = read_room({.product = 0x24});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double elevation_deg = std::asin(cloud.positions[i].z() / cloud.positions[i].norm()) * 180 / std::numbers::pi;
    // The vertical offsets of up to 7.4 mm are seen under less than 0.1 degrees.
    ASSERT_NEAR(elevation_deg, -10 + 20. / 15 * cloud.rings[i], 0.1);
  }
}

TEST_F(Vlp16Pcap, DualReturnsGiveTheSecondEchoOnlyWhereItDiffers) {
  const Vlp16Recording recording{.num_packets = 50, .has_dual_returns = true};
  const PointCloud cloud = read_room(recording);

  ASSERT_EQ(cloud.size(), 50U * 12 * (8 * 1 + 8 * 2));  // 12 firings a packet, odd rings see glass before the wall
  std::size_t num_on_glass = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d on_wall = point_on_wall(recording, cloud.times[i], cloud.rings[i]);
    const Eigen::Vector3d on_glass = point_on_wall(recording, cloud.times[i], cloud.rings[i], 0.5);
    const bool is_on_glass = (cloud.positions[i] - on_glass).norm() < kPositionTolerance;
    num_on_glass += is_on_glass ? 1 : 0;
    ASSERT_TRUE(is_on_glass || (cloud.positions[i] - on_wall).norm() < kPositionTolerance) << "point " << i;
  }
  EXPECT_EQ(num_on_glass, cloud.size() / 3);
  EXPECT_TRUE(std::is_sorted(cloud.times.begin(), cloud.times.end()));
}

TEST_F(Vlp16Pcap, TimesGoOnOverTheHour) {
  const PointCloud cloud = read_room({.num_packets = 20, .start_us = 3'599'990'000});

  EXPECT_NEAR(cloud.times.front(), 3599.99, kTimeTolerance);
  EXPECT_NEAR(cloud.times.back(), 3599.99 + 480 * 55.296e-6 - 55.296e-6 + 15 * 2.304e-6, kTimeTolerance);
  EXPECT_TRUE(std::is_sorted(cloud.times.begin(), cloud.times.end()));
}

TEST_F(Vlp16Pcap, LasersWithoutEchoGiveNoPoint) {
  const PointCloud cloud = read_room({.num_packets = 76, .unseen_beyond = 8});  // a whole turn

  EXPECT_GT(cloud.size(), 0U);
  EXPECT_LT(cloud.size(), 76U * 384U);
  for (const Eigen::Vector3d& position : cloud.positions) ASSERT_LT(position.norm(), 8.02);
}

TEST_F(Vlp16Pcap, ScansAreCutWhereTheAzimuthPassesZero) {
  const Vlp16Recording recording{.num_packets = 200, .start_azimuth_deg = 270, .start_us = 5'000'000};  // 2.65 turns
  const PointCloud whole = read_room(recording);
  const std::vector<PointCloud> scans = read_vlp16_scans(path_);

  ASSERT_EQ(scans.size(), 4U);
  std::size_t num_points = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].times.size(), scans[i].size());
    EXPECT_EQ(scans[i].rings.size(), scans[i].size());
    EXPECT_EQ(scans[i].intensities.size(), scans[i].size());
    EXPECT_EQ(scans[i].positions.front(), whole.positions[num_points]);
    num_points += scans[i].size();
    if (i == 0) continue;
    // A block lasts 111 us; the first azimuth in it decides.
    EXPECT_NEAR(scans[i].times.front() - 5, 0.025 + 0.1 * static_cast<double>(i - 1), 112e-6);
  }
  EXPECT_EQ(num_points, whole.size());
}

TEST_F(Vlp16Pcap, ScansAreCutWhereOnlyASectorReturnsEchoes) {
  const Vlp16Recording recording{.num_packets = 300, .unseen_beyond = 6.2};  // 3.98 turns; 6.2 m reaches a small sector
  const std::vector<PointCloud> scans = (read_room(recording), read_vlp16_scans(path_));

  ASSERT_EQ(scans.size(), 4U);
  for (const PointCloud& scan : scans) EXPECT_LT(scan.times.back() - scan.times.front(), 0.1);
}

TEST_F(Vlp16Pcap, EveryLinkLayerGivesTheSamePoints) {
  const std::vector<std::string> payloads = test::vlp16_payloads(room_, {.num_packets = 2});
  const PointCloud expected = read_room({.num_packets = 2});

  for (const int link_type : {0, 1, 101, 108, 113, 228, 276}) {
    for (const int num_vlan_tags : {0, 1, 2}) {
      if (num_vlan_tags > 0 && link_type != 1) continue;
      std::vector<std::string> frames;
      for (const std::string& payload : payloads) {
        frames.push_back(test::link_frame(link_type, test::ipv4_udp_packet(payload), num_vlan_tags));
      }
      EXPECT_EQ(read_vlp16_pcap(write(test::pcap_file(link_type, frames))).cloud.positions, expected.positions)
          << "link layer " << link_type;
    }
  }
  EXPECT_NE(error_for(test::pcap_file(105, {payloads[0]})).find("link layer 105 is not supported"), std::string::npos);
}

TEST_F(Vlp16Pcap, OtherTrafficIsPassedOver) {
  const std::string payload = test::vlp16_payloads(room_, {})[0];
  const auto ethernet = [](const std::string& packet) { return test::link_frame(1, packet); };
  std::string fragment = test::ipv4_udp_packet(payload);
  fragment[6] = '\x20';
  std::string tcp = test::ipv4_udp_packet(payload);
  tcp[9] = 6;
  std::string short_header = test::ipv4_udp_packet(payload);
  short_header[0] = '\x44';

  const std::string capture = test::pcap_file(
      1, {ethernet(test::ipv4_udp_packet(std::string(512, 'p'), 8308)), ethernet(test::ipv4_udp_packet("")),
          ethernet(""), "", "x", ethernet(test::ipv4_udp_packet(std::string(1206, 'v'))), ethernet(fragment),
          ethernet(tcp), ethernet(short_header), ethernet(test::ipv4_udp_packet(payload))});
  const ReadResult result = read_vlp16_pcap(write(capture));
  // Two datagrams came from the sensor to its port and hold no data.
  EXPECT_EQ(result.findings,
            (std::vector<ReadFinding>{{"damaged data packets left out", 2, "packet 2: 0 bytes, expected 1206", true}}));
  EXPECT_EQ(result.cloud.positions, read_room({}).positions);
}

TEST_F(Vlp16Pcap, OneSensorOfSeveralIsDecoded) {
  const std::vector<std::string> other = test::vlp16_payloads(room_, {.num_packets = 2, .start_azimuth_deg = 90});
  const std::string ours = test::vlp16_payloads(room_, {})[0];
  const auto frame = [](const std::string& payload, std::uint16_t port, std::uint8_t source) {
    return test::link_frame(1, test::ipv4_udp_packet(payload, port, source));
  };
  const auto expected = read_room({}).positions;

  // The usual port is preferred, even where it comes later.
  write(test::pcap_file(1, {frame(other[0], 2369, 1), frame(ours, 2368, 2), frame(other[1], 2369, 1)}));
  EXPECT_EQ(read_vlp16_pcap(path_).cloud.positions, expected);
  // Else the first sensor, whatever its port.
  write(test::pcap_file(1, {frame(ours, 5000, 2), frame(other[0], 5000, 3), frame(other[1], 5001, 2)}));
  EXPECT_EQ(read_vlp16_pcap(path_).cloud.positions, expected);
}

TEST_F(Vlp16Pcap, OtherSensorsAreNamedAndCanBeChosen) {
  const auto frame = [](const std::string& payload, std::uint16_t port, std::uint8_t source) {
    return test::link_frame(1, test::ipv4_udp_packet(payload, port, source));
  };
  // Three VLP-16, and one Puck Hi-Res that has the address of the first, as both left their factory.
  const std::vector<Vlp16Recording> recordings = {{.start_azimuth_deg = 10},
                                                  {.start_azimuth_deg = 20},
                                                  {.start_azimuth_deg = 30},
                                                  {.start_azimuth_deg = 40, .product = 0x24}};
  std::vector<std::string> payloads;
  std::vector<PointCloud> expected;
  for (const Vlp16Recording& recording : recordings) {
    payloads.push_back(test::vlp16_payloads(room_, recording)[0]);
    expected.push_back(read_room(recording));
  }
  write(test::pcap_file(1, {frame(payloads[0], 2368, 201), frame(payloads[1], 2368, 202), frame(payloads[2], 2369, 202),
                            frame(payloads[1], 2368, 202), frame(payloads[3], 2368, 201)}));

  const ReadResult first = read_vlp16_pcap(path_);
  EXPECT_EQ(first.cloud.positions, expected[0].positions);
  const auto left_out = [](const std::string& place) {
    return "a second sensor at " + place + " is left out: --sensor " + place + " chooses it";
  };
  EXPECT_EQ(first.findings,
            (std::vector<ReadFinding>{{left_out("192.168.1.202:2368"), 0, "VLP-16, 2 data packets"},
                                      {left_out("192.168.1.202:2369"), 0, "VLP-16, 1 data packets"},
                                      {left_out("192.168.1.201:2368/0x24"), 0, "Puck Hi-Res, 1 data packets"}}));

  const auto points_of = [&](const std::string& choice) {
    const ReadResult result = read_vlp16_pcap(path_, {.sensor = parse_sensor_choice(choice)});
    EXPECT_TRUE(result.findings.empty()) << choice;
    return result.cloud.positions;
  };
  EXPECT_EQ(points_of("192.168.1.201"), expected[0].positions);
  EXPECT_EQ(points_of("192.168.1.201:2368/0x24"), expected[3].positions);
  EXPECT_EQ(points_of("192.168.1.202").size(), 2 * expected[1].size());
  EXPECT_EQ(points_of("192.168.1.202:2369"), expected[2].positions);
  EXPECT_EQ(
      test::io_error_of([&] { points_of("192.168.1.7"); }),
      "room.pcap: no sensor at 192.168.1.7, only 192.168.1.201:2368/0x22, 192.168.1.202:2368, 192.168.1.202:2369, "
      "192.168.1.201:2368/0x24");
}

TEST_F(Vlp16Pcap, ASensorThatCanBeDecodedComesBeforeOneThatCannot) {
  const std::string ours = test::vlp16_payloads(room_, {})[0];
  std::string other = ours;
  other[1205] = '\x28';
  write(test::pcap_file(1, {test::link_frame(1, test::ipv4_udp_packet(other, 2368, 9)),
                            test::link_frame(1, test::ipv4_udp_packet(ours, 2369, 8))}));
  const ReadResult result = read_vlp16_pcap(path_);
  EXPECT_EQ(result.cloud.size(), 384U);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].first, "VLP-32C (product id 0x28), 1 data packets");
}

TEST_F(Vlp16Pcap, TruncationAnywhereLeavesTheWholePacketsOrIsAnError) {
  const std::string whole = test::ethernet_capture(test::vlp16_payloads(room_, {.num_packets = 2}));
  constexpr std::size_t kFirstPacketEnd = 24 + 16 + 42 + 1206;

  write(whole);
  for (std::size_t size = whole.size() - 1; size > 0; --size) {
    std::filesystem::resize_file(path_, size);
    if (size < kFirstPacketEnd) {
      EXPECT_THROW(read_vlp16_pcap(path_), IoError) << size;
      EXPECT_THROW(read_vlp16_scans(path_), IoError) << size;
      continue;
    }
    const ReadResult result = read_vlp16_pcap(path_);
    EXPECT_EQ(result.cloud.size(), 384U);
    EXPECT_EQ(read_vlp16_scans(path_).size(), 1U);
    EXPECT_EQ(result.findings.size(), size == kFirstPacketEnd ? 0U : 1U) << size;
  }
}

TEST_F(Vlp16Pcap, WhatFollowsADamagedRecordIsLeftOut) {
  const std::vector<std::string> payloads = test::vlp16_payloads(room_, {.num_packets = 3});
  const PointCloud first = read_room({});
  std::string capture = test::ethernet_capture(payloads);
  const std::size_t second_record_at = 24 + 16 + 42 + 1206;
  for (const char* length : {"\xff\xff\xff\xff", "\xff\xff\xff\x7f", "\x00\x00\x01\x00"}) {
    capture.replace(second_record_at + 8, 4, length, 4);
    const ReadResult result = read_vlp16_pcap(write(capture));
    EXPECT_EQ(result.cloud.positions, first.positions);
    ASSERT_EQ(result.findings.size(), 1U);
    EXPECT_EQ(result.findings[0].what, "the capture is cut off or damaged, its rest is left out");
    EXPECT_EQ(result.findings[0].first.substr(0, 10), "packet 2: ");
    EXPECT_TRUE(result.findings[0].is_damage);
  }
}

TEST_F(Vlp16Pcap, AnyDamagedByteOfHeadersIsReadOrRefusedButNeverCrashes) {
  const std::string whole = test::ethernet_capture(test::vlp16_payloads(room_, {}));
  for (std::size_t at = 0; at < 24 + 16 + 42; ++at) {
    for (const char value : {'\x00', '\x01', '\x7f', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = value;
      write(damaged);
      try {
        EXPECT_LE(read_vlp16_pcap(path_).cloud.size(), 384U);
      } catch (const IoError&) {
      }
    }
  }
}

// A value overwritten in a data packet, and what is then wrong with it.
struct PacketDamage {
  std::size_t at;
  std::string bytes;
  std::string defect;
};

const std::vector<PacketDamage> kPacketDamages = {
    {0, std::string(2, '\0'), "data block 0 lacks its flag"},
    {300, "\xff\xdd", "data block 3 lacks its flag"},
    {102, "\xa0\x8c", "azimuth 36000 of data block 1, expected 0..35999"},
    {502, std::string("\x00\x00", 2), "the azimuths of its data blocks do not rise"},
    {502, "\x9f\x8c", "the azimuths of its data blocks do not rise"},  // 359.99 degrees
    {1204, "\x3a", "return mode 58, expected 55 (strongest), 56 (last) or 57 (dual)"},
    {1205, "\x28", "sensor VLP-32C (product id 0x28) is not supported, only VLP-16, Puck Hi-Res and HDL-32E"}};

TEST_F(Vlp16Pcap, ADamagedPacketIsLeftOutAndNamed) {
  std::vector<std::string> payloads = test::vlp16_payloads(room_, {.num_packets = 5, .start_azimuth_deg = 90});
  const std::vector<std::string> whole = payloads;
  payloads.erase(payloads.begin() + 2);
  const PointCloud expected = read_vlp16_pcap(write(test::ethernet_capture(payloads))).cloud;

  for (const PacketDamage& damage : kPacketDamages) {
    payloads = whole;
    payloads[2].replace(damage.at, damage.bytes.size(), damage.bytes);
    const ReadResult result = read_vlp16_pcap(write(test::ethernet_capture(payloads)));
    EXPECT_EQ(result.cloud.positions, expected.positions) << damage.defect;
    EXPECT_EQ(result.cloud.times, expected.times) << damage.defect;
    EXPECT_EQ(result.findings,
              (std::vector<ReadFinding>{{"damaged data packets left out", 1, "packet 3: " + damage.defect, true}}));
  }
  for (const std::size_t size : {1000, 1205, 1207}) {
    payloads = whole;
    payloads[2].resize(size);
    const ReadResult result = read_vlp16_pcap(write(test::ethernet_capture(payloads)));
    EXPECT_EQ(result.cloud.positions, expected.positions) << size;
    EXPECT_EQ(result.findings[0].first, "packet 3: " + std::to_string(size) + " bytes, expected 1206");
  }
}

TEST_F(Vlp16Pcap, AWrongTimeOfOnePacketShiftsNoOther) {
  std::vector<std::string> payloads = test::vlp16_payloads(room_, {.num_packets = 5, .start_us = 3'599'999'000});
  const std::vector<std::string> whole = payloads;
  payloads.erase(payloads.begin() + 2);
  const PointCloud expected = read_vlp16_pcap(write(test::ethernet_capture(payloads))).cloud;
  EXPECT_GT(expected.times.back(), 3600.0);  // over the hour

  for (const std::uint32_t time_us : {1'800'000'000U, 5'000'000U, 0xffffffffU}) {
    payloads = whole;
    std::memcpy(payloads[2].data() + 1200, &time_us, 4);
    const ReadResult result = read_vlp16_pcap(write(test::ethernet_capture(payloads)));
    EXPECT_EQ(result.cloud.times, expected.times) << time_us;
    ASSERT_EQ(result.findings.size(), 1U);
    EXPECT_EQ(result.findings[0].first, "packet 3: time stamp " + std::to_string(time_us) + " us, expected about 2981");
  }
}

TEST_F(Vlp16Pcap, WithoutAWholePacketTheFirstDefectIsTheError) {
  for (const PacketDamage& damage : kPacketDamages) {
    std::string payload = test::vlp16_payloads(room_, {.start_azimuth_deg = 90})[0];
    payload.replace(damage.at, damage.bytes.size(), damage.bytes);
    if (damage.at == 0) continue;  // then nothing says that it is Velodyne's
    EXPECT_EQ(error_for(test::ethernet_capture({payload, payload})), path_.string() + ": packet 1: " + damage.defect);
  }
}

TEST_F(Vlp16Pcap, ASectorThatEndsWithinAPacketIsNoDamage) {
  std::string payload = test::vlp16_payloads(room_, {.start_azimuth_deg = 40})[0];
  for (std::size_t block = 6; block < 12; ++block) {  // from 41.2 degrees on to 320
    const auto azimuth = static_cast<std::uint16_t>(32000 + 40 * block);
    std::memcpy(payload.data() + block * 100 + 2, &azimuth, 2);
  }
  const ReadResult result = read_vlp16_pcap(write(test::ethernet_capture({payload})));
  EXPECT_EQ(result.cloud.size(), 384U);
  EXPECT_TRUE(result.findings.empty());
}

TEST_F(Vlp16Pcap, PacketsCutOffByTheCaptureAreAnError) {
  const std::string frame = test::link_frame(1, test::ipv4_udp_packet(test::vlp16_payloads(room_, {})[0]));
  EXPECT_EQ(error_for(test::pcap_file(1, {frame}, 100)),
            path_.string() + ": packet 1: only 58 of 1206 bytes were captured");
}

TEST_F(Vlp16Pcap, NoPointsAreAnError) {
  EXPECT_EQ(error_for(test::pcap_file(1, {})),
            path_.string() + ": holds no points: no returns in Velodyne data packets among 0 packets");
  EXPECT_THROW(read_room({.unseen_beyond = 1}), IoError);
}

TEST_F(Vlp16Pcap, AMissingFileIsASystemError) {
  try {
    read_vlp16_pcap(folder_ / "absent.pcap");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_EQ(error.kind(), IoError::Kind::kSystem);
  }
  EXPECT_THROW(read_vlp16_pcap(folder_.path()), IoError);
}

// Raw access to captures of Ethernet frames with one data packet each, independent of the library under test.
std::vector<std::string> raw_payloads(const std::filesystem::path& path) {
  ByteReader file(path);
  std::vector<std::string> payloads;
  file.skip(24);
  while (file.remaining() > 0) {
    file.skip(8);
    const auto size = file.read_le<std::uint32_t>();
    file.skip(4);
    const std::string_view frame = file.bytes(size);
    if (frame.size() == 42 + 1206) payloads.emplace_back(frame.substr(42));
  }
  return payloads;
}

std::vector<double> raw_distances(const std::vector<std::string>& payloads) {
  std::vector<double> distances;
  for (const std::string& payload : payloads) {
    for (std::size_t i = 0; i < 12 * 32; ++i) {
      const auto distance = load<std::uint16_t>(payload.data() + i / 32 * 100 + 4 + i % 32 * 3);
      if (distance > 0) distances.push_back(distance * 0.002);
    }
  }
  return distances;
}

TEST_F(Vlp16Pcap, RecordedVlp16PacketsGiveAllTheirReturns) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  const auto path = *data / "velodyne" / "vlp16_bench.pcap";
  const PointCloud cloud = read_vlp16_pcap(path).cloud;
  const std::vector<std::string> payloads = raw_payloads(path);
  const std::vector<double> distances = raw_distances(payloads);

  ASSERT_EQ(payloads.size(), 293U);
  ASSERT_EQ(cloud.size(), distances.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double offset = test::vlp16_vertical_offset(cloud.rings[i]);
    const Eigen::Vector3d from_laser = cloud.positions[i] - Eigen::Vector3d(0, 0, offset);
    ASSERT_NEAR(from_laser.norm(), distances[i], 1e-9) << "point " << i;
    ASSERT_NEAR(std::asin(from_laser.z() / distances[i]), test::vlp16_elevation(cloud.rings[i]), 1e-9);
  }
  EXPECT_TRUE(std::is_sorted(cloud.times.begin(), cloud.times.end()));
  // 293 packets of 1.327 ms without a gap; 10 turns a second make 3.9 turns of them.
  EXPECT_NEAR(cloud.times.back() - cloud.times.front(), 293 * 24 * 55.296e-6, 0.002);
  EXPECT_EQ(read_vlp16_scans(path).size(), 5U);
}

TEST_F(Vlp16Pcap, RecordedHdl32PacketsGiveAllTheirReturns) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  const auto path = *data / "velodyne" / "hdl32.pcap";
  const PointCloud cloud = read_vlp16_pcap(path).cloud;
  const std::vector<double> distances = raw_distances(raw_payloads(path));

  ASSERT_EQ(cloud.size(), distances.size());
  std::map<std::uint16_t, double> lowest_z;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_NEAR(cloud.positions[i].norm(), distances[i], 1e-9) << "point " << i;
    const double elevation_deg = std::asin(cloud.positions[i].z() / distances[i]) * 180 / std::numbers::pi;
    ASSERT_NEAR(elevation_deg, -30.67 + 41.34 / 31 * cloud.rings[i], 0.01);  // the data sheet's -30.67 to +10.67
    double& lowest = lowest_z[cloud.rings[i]];
    lowest = std::min(lowest, cloud.positions[i].z());
  }
  EXPECT_EQ(lowest_z.size(), 31U);  // one laser of that sensor gives no echo
  // The lower lasers see a road, which only true elevations leave at one height.
  for (std::uint16_t ring = 0; ring < 16; ++ring) EXPECT_NEAR(lowest_z[ring], -2.33, 0.15) << "ring " << ring;
  EXPECT_TRUE(std::is_sorted(cloud.times.begin(), cloud.times.end()));
}

// A packet of a sensor that does not turn, in which one laser has an echo.
std::string payload_of_one_echo(double azimuth, std::uint16_t ring, double distance) {
  const auto azimuth_units = static_cast<std::uint16_t>(std::lround(azimuth * 18000 / std::numbers::pi) % 36000);
  const auto distance_units = static_cast<std::uint16_t>(std::lround(distance / 0.002));
  std::string payload(1206, '\0');
  for (std::size_t block = 0; block < 12; ++block) {
    std::memcpy(payload.data() + block * 100, "\xff\xee", 2);
    std::memcpy(payload.data() + block * 100 + 2, &azimuth_units, 2);
  }
  const std::size_t laser = ring % 8 * std::size_t{2} + ring / 8;
  std::memcpy(payload.data() + 4 + 3 * laser, &distance_units, 2);
  payload[1204] = '\x37';
  payload[1205] = '\x22';
  return payload;
}

TEST_F(Vlp16Pcap, TheFrameIsThatOfAnotherDriver) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  ByteReader file(*data / "velodyne" / "vlp16_decoded.pcd");
  while (!file.read_line().starts_with("DATA binary")) {
  }

  // Records of x y z intensity:u8 return:u8 channel:u16 azimuth elevation distance time.
  for (; file.remaining() >= 32; file.skip(31 * 32)) {
    const std::string_view record = file.bytes(32);
    const Eigen::Vector3d expected(load<float>(record.data()), load<float>(record.data() + 4),
                                   load<float>(record.data() + 8));
    const auto ring = load<std::uint16_t>(record.data() + 14);
    const double distance = load<float>(record.data() + 24);
    const std::string payload = payload_of_one_echo(load<float>(record.data() + 16), ring, distance);
    std::vector<VelodyneReturn> returns;
    decode_velodyne_packet(VelodynePayload(reinterpret_cast<const std::uint8_t*>(payload.data()), 1206), returns);

    ASSERT_EQ(returns.size(), 1U);
    EXPECT_EQ(returns[0].ring, ring);
    // That driver leaves the lasers' vertical offsets out. Azimuths are rounded to 0.005 degrees here.
    const Eigen::Vector3d decoded =
        returns[0].point_in_lidar - Eigen::Vector3d(0, 0, test::vlp16_vertical_offset(ring));
    EXPECT_LT((decoded - expected).norm(), 1e-4 * distance + 1e-4);
    if (file.remaining() < 31 * 32) break;
  }
}

}  // namespace
}  // namespace vdbmap
