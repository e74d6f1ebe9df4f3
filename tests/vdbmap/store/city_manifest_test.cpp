// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/city_manifest.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/sample_maps.h"
#include "vdbmap/core/error.h"
#include "vdbmap/core/map_tiles.h"

namespace vdbmap {
namespace {

CityManifest sample_manifest() {
  CityManifest manifest;
  manifest.epoch = 3;
  manifest.layout = {
      {{548'864, 5'804'032, -64}, 25832}, {0.1, 1}, true, {"intensity", "label"}, LabelScheme::kAsprs, 12.5F};
  manifest.tiles = {{{-2, 7}, "0123456789abcdef0123", 123'456, 99, {40, 4}, {{-128.1, 448, 0.3}, {-64, 512, 9}}},
                    {{0, -1}, "00000000000000000001", 7, 1, {1, 1}, {{0, -0.1, 0}, {0.1, 0, 0.1}}}};
  manifest.sources = {{"a \"b\".las", "0123456789abcdef0123456789abcdef", 100, 3}};
  manifest.parts = {{"0123456789abcdef0123456789abcdef", "00112233445566778899aabbccddeeff", 4'567}};
  return manifest;
}

// What parsing says of a text; empty where it takes it.
std::string problem_of(const std::string& text) {
  try {
    parse_city_manifest(text, "map.json");
    return "";
  } catch (const IoError& error) {
    EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
    return error.what();
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(CityManifest, IsReadAsItWasWritten) {
  const CityManifest manifest = sample_manifest();
  EXPECT_EQ(parse_city_manifest(text_of(manifest), "map.json"), manifest);
  EXPECT_EQ(text_of(parse_city_manifest(text_of(manifest), "map.json")), text_of(manifest));

  CityManifest bare;
  bare.layout.voxel_sizes = {0.5};
  bare.layout.density = 50;
  EXPECT_EQ(parse_city_manifest(text_of(bare), "map.json"), bare);
}

TEST(CityManifest, EveryPlaceWhereItIsCutIsDamage) {
  const std::string text = text_of(sample_manifest());
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    EXPECT_EQ(problem_of(text.substr(0, size)), "map.json: is damaged: it is no JSON object") << size;
  }
}

TEST(CityManifest, ANewerOneIsRefused) {
  const std::string text = replaced(text_of(sample_manifest()), "\"version\": 1", "\"version\": 3");
  EXPECT_EQ(problem_of(text), "map.json: version is 3, newer than the 2 that this program knows");
}

TEST(CityManifest, WithRaysOrDatesIsOfTheNextVersionAndReadAsItWasWritten) {
  CityManifest manifest = sample_manifest();
  manifest.tiles.push_back({{3, 0}, "00000000000000000002", 9, 0, {0, 0}});
  manifest.tiles.back().has_rays = true;
  manifest.epochs = {{3, "2023-09-14", {1, 2, 3, 4, 5, 6}}};
  const std::string text = text_of(manifest);
  EXPECT_NE(text.find("\"version\": 2"), std::string::npos);
  EXPECT_EQ(parse_city_manifest(text, "map.json"), manifest);
  EXPECT_TRUE(has_rays(manifest));
  EXPECT_EQ(extent(manifest)->max, extent(sample_manifest())->max);
  // Without rays, a tile has voxels.
  EXPECT_NE(problem_of(replaced(text, ",\"rays\":true", "")).find("tiles[2].voxels"), std::string::npos);
}

TEST(CityManifest, WhatCannotBeIsNamedWithItsPlace) {
  const std::vector<std::array<std::string, 3>> changes = {
      {"\"vdbmap city\"", "\"other\"", "format is not 'vdbmap city'"},
      {"\"epoch\": 3", "\"epoch\": -3", "epoch is below 0"},
      {"\"epoch\": 3", "\"epoch\": 3e9", "epoch is no whole number of 32 bits"},
      {"\"epoch\": 3,\n", "", "epoch is missing"},
      {"548864.0", "548865.0", "anchor is no point of whole multiples of 64 m"},
      {"64.0", "32.0", "anchor is no point"},
      {"[0.1,1.0]", "[0.1,0.25]", "voxel_sizes[1] cannot be"},
      {"[0.1,1.0]", "[]", "voxel_sizes is empty"},
      {"[\"intensity\",\"label\"]", "[\"label\",\"intensity\"]", "channels names something else"},
      {"asprs", "esri", "label_scheme is not known"},
      {"0123456789abcdef0123\"", "../../../../etc/abcde\"", "tiles[0].hash is no hash"},
      {"[40,4]", "[40]", "tiles[0].voxels is no list of 2"},
      {"[40,4]", "[0,4]", "tiles[0].voxels is no list of 2 numbers of voxels above 0"},
      {"\"x\":0", "\"x\":-3", "tiles[1] is out of order"},
      {"{\"source\":\"0", "{\"source\":\"1", "parts[0].source is no source"},
      {"\"00112233", "\"../../33", "parts[0].hash is no hash"},
      {"\"bytes\":4567", "\"bytes\":4.5", "parts[0].bytes is no whole number"},
      {"\"parts\": [", "\"parts\": 3, \"x\": [", "parts is no list"},
      {"\"points\":100", "\"points\":-1", "sources[0].points is no whole number from 0 on"},
  };
  for (const auto& [from, to, expected] : changes) {
    const std::string problem = problem_of(replaced(text_of(sample_manifest()), from, to));
    EXPECT_NE(problem.find("map.json: " + expected), std::string::npos) << from << ": " << problem;
  }
}

TEST(CityManifest, PartsAreKeptOfEachSourceOrOfNone) {
  CityManifest manifest = sample_manifest();
  EXPECT_TRUE(keeps_parts(manifest));
  EXPECT_EQ(find_part(manifest, manifest.sources[0].hash)->num_bytes, 4'567U);
  EXPECT_FALSE(find_part(manifest, "ffff"));
  manifest.sources.push_back({"c.las", "1123456789abcdef0123456789abcdef", 100, 3});
  EXPECT_FALSE(keeps_parts(manifest));  // another writer may add what it keeps no part of
  EXPECT_FALSE(keeps_parts(CityManifest()));
}

TEST(CityManifest, CountsATileAsItsMapDoes) {
  const VoxelMap map = test::sample_map();
  const CityTile tile = describe_tile({0, 0}, map);
  EXPECT_EQ(tile.num_points, num_points(map.finest()));
  ASSERT_EQ(tile.num_voxels.size(), 2U);
  EXPECT_EQ(tile.num_voxels[0], map.finest().size());
  EXPECT_EQ(tile.num_voxels[1], map.coarsest().size());
  EXPECT_EQ(tile.extent.min, extent(map)->min);
}

TEST(CityManifest, TheExtentIsThatOfAllTiles) {
  const std::optional<Extent> box = extent(sample_manifest());
  ASSERT_TRUE(box);
  EXPECT_EQ(box->min, Eigen::Vector3d(-128.1, -0.1, 0));
  EXPECT_EQ(box->max, Eigen::Vector3d(0.1, 512, 9));
  EXPECT_FALSE(extent(CityManifest()));
  EXPECT_EQ(num_points(sample_manifest()), 100U);
  EXPECT_EQ(num_voxels(sample_manifest()), (std::vector<std::uint64_t>{41, 5}));
}

}  // namespace
}  // namespace vdbmap
