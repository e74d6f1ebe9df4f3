// SPDX-License-Identifier: GPL-3.0-or-later
// Real scans, on which the network was not trained.
#include <filesystem>

#include <gtest/gtest.h>

#include "parking/segmentation/default_weights.h"
#include "parking/segmentation/segment.h"
#include "tests/support/folders.h"
#include "vdbmap/io/file/byte_reader.h"
#include "vdbmap/io/points/point_reader.h"

namespace vdbmap::parking {
namespace {

// kitti00/labels: 1 car, 4 truck, 5 other vehicle; 0 and 255 say nothing.
TEST(SegmentKitti, VehiclesOfASingleScanAreFoundAndLittleElseIsTakenForOne) {
  const auto data = test::real_data_folder();
  if (!data) GTEST_SKIP() << test::kNeedsRealData;
  const NetworkWeights network = *read_network(default_weights());
  double hits = 0, missed = 0, wrong = 0, others = 0;
  for (const char* name : {"000003", "000012"}) {
    const ReadResult scan = read_points(*data / "kitti00" / "velodyne" / (std::string(name) + ".bin"));
    ByteReader truth(*data / "kitti00" / "labels" / (std::string(name) + ".u8"));
    const auto labels = point_labels(scan.cloud, network);
    for (const std::int32_t label : labels) {
      const auto kitti = truth.read_le<std::uint8_t>();
      truth.skip(1);
      if (kitti == 0 || kitti == 255) continue;
      const bool is_vehicle = kitti == 1 || kitti == 4 || kitti == 5;
      const bool is_called_so = label == semantic_kitti_label(SurfaceClass::kVehicle);
      (is_vehicle ? (is_called_so ? hits : missed) : (is_called_so ? wrong : others)) += 1;
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GE(hits / (hits + missed + wrong), 0.85);
  EXPECT_LE(wrong / (wrong + others), 0.01);
}

}  // namespace
}  // namespace vdbmap::parking
