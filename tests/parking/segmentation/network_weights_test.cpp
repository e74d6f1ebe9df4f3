// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/network_weights.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <zlib.h>

#include "tests/support/folders.h"
#include "tests/support/raw_files.h"
#include "vdbmap/core/error.h"

namespace vdbmap::parking {
namespace {

const std::string kShipped = VDBMAP_SOURCE_DIR "/assets/segmentation/street.kpconv";

class NetworkWeightsFile : public testing::Test {
 protected:
  // What the reader says of these bytes; empty where it takes them.
  std::string refusal(const std::string& bytes) const {
    const auto path = folder_ / "w.kpconv";
    test::write_raw(path, bytes);
    try {
      read_network(path);
      return "";
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      EXPECT_EQ(std::string(error.what()).find(path.string()), 0U) << error.what();
      return error.what();
    }
  }

  static std::string with_checksum(std::string bytes) {
    bytes.resize(bytes.size() - 4);
    const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(sum >> (8 * i) & 0xff));
    return bytes;
  }

  // The shipped file with one part of its header changed, and its checksum made anew.
  static std::string changed(const std::string& part, const std::string& by) {
    std::string bytes = test::read_raw(kShipped);
    const std::size_t place = bytes.find(part);
    EXPECT_NE(place, std::string::npos) << part;
    EXPECT_EQ(part.size(), by.size());
    return with_checksum(bytes.replace(place, part.size(), by));
  }

  test::TemporaryFolder folder_;
};

TEST_F(NetworkWeightsFile, OfTheProjectHasTheShapesOfItsNetwork) {
  const NetworkWeights network = *read_network(kShipped);
  EXPECT_EQ(network.first.weights.rows(), 15 * 4);
  EXPECT_EQ(network.first.weights.cols(), 32);
  ASSERT_EQ(network.encoder[1].size(), 2U);
  EXPECT_TRUE(network.encoder[1][0].shortcut);
  EXPECT_FALSE(network.encoder[1][1].shortcut);
  EXPECT_EQ(network.encoder[4][1].convolution.weights.rows(), 15 * 128);
  EXPECT_EQ(network.decoder[0].weights.rows(), 64 + 32);
  EXPECT_EQ(network.scores.bias.size(), 7);
  EXPECT_NE(network.training.find("\"voxels\""), std::string::npos);
}

TEST_F(NetworkWeightsFile, IsRefusedCutOffAnywhere) {
  const std::string bytes = test::read_raw(kShipped);
  for (std::size_t size = 0; size < 4096; size += 61) EXPECT_NE(refusal(bytes.substr(0, size)), "") << size;
  for (const std::size_t cut : {1, 2, 4, 1000}) EXPECT_NE(refusal(bytes.substr(0, bytes.size() - cut)), "") << cut;
  EXPECT_NE(refusal(bytes + "x"), "");
}

TEST_F(NetworkWeightsFile, IsRefusedWithAnyByteChanged) {
  std::string bytes = test::read_raw(kShipped);
  for (std::size_t i = 0; i < bytes.size(); i += bytes.size() / 40) {
    bytes[i] = static_cast<char>(bytes[i] ^ 0x10);
    EXPECT_NE(refusal(bytes), "") << i;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x10);
  }
  EXPECT_EQ(refusal(bytes), "");
}

TEST_F(NetworkWeightsFile, SaysWhatDoesNotFit) {
  std::string other_version = test::read_raw(kShipped);
  other_version[8] = 2;
  std::string no_number = test::read_raw(kShipped);
  no_number.replace(no_number.size() - 6, 2, "\xff\x7f");  // a NaN
  const std::pair<std::string, std::string> refused[] = {
      {"P6 1 1 255\n" + std::string(40, 'x'), "is no file of network weights"},
      {with_checksum(other_version), "weights of version 2, this program reads version 1"},
      {with_checksum(no_number), "no number"},
      {changed("\"ground\"", "\"grownd\""), "other classes"},
      {changed("\"one\"", "\"two\""), "other features"},
      {changed("\"finest\": 0.1", "\"finest\": 0.2"), "another size than 0.1 m"},
      {changed("\"neighbours\": 28", "\"neighbours\": 27"), "number of neighbours"},
      {changed("\"widths\": [32", "\"widths\": [40"), "[\"first.weights\",60,32] where [\"first.weights\",60,40]"},
      {changed("\"widths\": [32", "\"widths\": [36"), "no multiple of 8"},
      {changed("\"blocks\": [1, 2", "\"blocks\": [1, 1"), "belongs"},
      {changed("\"blocks\": [1, 2", "\"blocks\": [1, 0"), "\"blocks\" that are none from 1 to 16"},
      {changed("\"head.bias\"", "\"head.bios\""), "where [\"head.bias\",1,32] belongs"},
  };
  for (const auto& [bytes, part] : refused) {
    EXPECT_NE(refusal(bytes).find(part), std::string::npos) << part << ": " << refusal(bytes);
  }
  EXPECT_THROW(read_network(folder_ / "missing"), IoError);
}

}  // namespace
}  // namespace vdbmap::parking
