// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/vdb/visibility_file.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/sample_maps.h"
#include "vdbmap/change/ray_evidence.h"
#include "vdbmap/core/error.h"
#include "vdbmap/io/vdb/map_check.h"
#include "vdbmap/io/vdb/map_file.h"

namespace vdbmap {
namespace {

// Rays all over the sample map, some thousand voxels and whole cubes of them.
Visibility sample_visibility(const VoxelMap& map) {
  RayEvidence evidence({&map}, {.clearance = 0});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-3, 3);
  std::vector<MeasuredRay> rays;
  for (int i = 0; i < 20000; ++i) {
    rays.push_back({{0.3 * place(random), 0.3 * place(random), 0.3 * place(random)},
                    {place(random), place(random), place(random)}});
  }
  evidence.add(rays);
  Visibility visibility;
  visibility.voxel_size = map.finest().voxel_size();
  visibility.seen_empty = evidence.seen_empty();
  visibility.passes = evidence.passes(0);
  for (std::size_t i = 0; i < map.finest().size(); ++i) visibility.hits.push_back(static_cast<std::uint32_t>(7 * i));
  return visibility;
}

void expect_equal(const Visibility& a, const Visibility& b) {
  EXPECT_EQ(a.voxel_size, b.voxel_size);
  EXPECT_EQ(a.hits, b.hits);
  EXPECT_EQ(a.passes, b.passes);
  ASSERT_EQ(a.seen_empty.leaves().size(), b.seen_empty.leaves().size());
  for (std::size_t i = 0; i < a.seen_empty.leaves().size(); ++i) {
    EXPECT_EQ(a.seen_empty.leaves()[i].origin(), b.seen_empty.leaves()[i].origin());
    EXPECT_EQ(a.seen_empty.leaves()[i].getValueMask(), b.seen_empty.leaves()[i].getValueMask());
  }
}

TEST(VisibilityFile, ComesBackAsItWas) {
  const test::TemporaryFolder folder;
  const VoxelMap map = test::sample_map();
  const Visibility visibility = sample_visibility(map);
  save_map(folder / "a.vdb", map, {visibility, {}});
  const VoxelMap loaded = load_map(folder / "a.vdb");
  EXPECT_EQ(test::difference(loaded, map), "");
  const std::optional<Visibility> read = load_visibility(folder / "a.vdb", loaded);
  ASSERT_TRUE(read);
  expect_equal(*read, visibility);
  EXPECT_TRUE(has_visibility(folder / "a.vdb"));
  EXPECT_TRUE(all_passed(check_map_file(folder / "a.vdb")));
}

TEST(VisibilityFile, AMapWithoutRaysHasNone) {
  const test::TemporaryFolder folder;
  const VoxelMap map = test::sample_map();
  save_map(folder / "a.vdb", map);
  EXPECT_FALSE(load_visibility(folder / "a.vdb", map));
  EXPECT_FALSE(has_visibility(folder / "a.vdb"));
}

TEST(VisibilityFile, ThatOfOtherVoxelsIsRefused) {
  const test::TemporaryFolder folder;
  const VoxelMap map = test::sample_map();
  save_map(folder / "a.vdb", map, {sample_visibility(map), {}});
  const VoxelMap other = test::map_of_voxels({{0, 0, 0}, {500, 0, 0}});
  EXPECT_THROW(load_visibility(folder / "a.vdb", other), IoError);
}

TEST(VisibilityFile, TheHistoryComesBackAsItWas) {
  const test::TemporaryFolder folder;
  const VoxelMap map = test::sample_map();
  MapHistory history;
  history.epochs = {{1, "2023-03-02", {}}, {2, "", {5, 4, 3, 2, 1, 6}}};
  history.sources = {{"a \"quoted\" \\ name.las", "0123456789abcdef0123456789abcdef", 12, 1}};
  save_map(folder / "a.vdb", map, {std::nullopt, history});
  EXPECT_EQ(load_history(folder / "a.vdb"), history);
  save_map(folder / "b.vdb", map);
  EXPECT_TRUE(load_history(folder / "b.vdb").empty());
}

}  // namespace
}  // namespace vdbmap
