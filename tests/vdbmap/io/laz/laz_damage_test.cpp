// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/laz_bytes.h"
#include "tests/support/raw_files.h"
#include "tests/support/sanitizers.h"
#include "vdbmap/io/las/las.h"

namespace vdbmap {
namespace {

using test::compress_las;
using test::LazLayout;
using test::random_las;
using test::write_raw;

constexpr std::size_t kPointsOffsetAt = 96;
constexpr std::size_t kLegacyNumPointsAt = 107;
constexpr std::size_t kNumPointsAt = 247;

// What the layouts differ in where damage is concerned.
struct DamageKind {
  std::string name;
  unsigned format = 0;
  LazLayout layout = {};
  bool can_be_cut = true;  // whether whole chunks can be found without the end of the file
};

std::vector<DamageKind> damage_kinds() {
  return {
      {"PointwiseFixed", 3, {.points_per_chunk = 20, .chunk_sizes = {}}},
      {"PointwiseVariable", 3, {.chunk_sizes = {20, 30, 10}}, false},
      {"PointwiseVersion1", 3, {.version = 1, .points_per_chunk = 20, .chunk_sizes = {}}},
      {"PointwiseOneChunk", 1, {.version = 1, .is_chunked = false, .chunk_sizes = {}}, false},
      {"LayeredFixed", 8, {.points_per_chunk = 20, .chunk_sizes = {}}},
      {"LayeredVariable", 7, {.chunk_sizes = {20, 30, 10}}},
      {"LayeredOffsetBehind", 6, {.points_per_chunk = 20, .chunk_sizes = {}, .has_offset_behind = true}},
  };
}

class LazDamage : public testing::TestWithParam<DamageKind> {
 protected:
  static constexpr std::size_t kNumPoints = 60;

  std::string bytes() const { return compress_las(random_las(GetParam().format, kNumPoints, 2, 3), GetParam().layout); }
  std::filesystem::path file(std::string_view laz) const { return write_raw(folder_ / "a.laz", laz); }

  // Points that are read, left out one by one, or counted as missing; nothing where the file is refused.
  std::optional<std::size_t> num_accounted(std::string_view laz) const {
    try {
      const ReadResult result = read_las(file(laz));
      std::size_t sum = result.cloud.size() + result.dropped.size();
      for (const ReadFinding& finding : result.findings) {
        if (finding.what == "points are missing that the header counts" ||
            finding.what == "points of LAZ chunks that cannot be true left out") {
          sum += finding.count;
        }
      }
      return sum;
    } catch (const IoError& error) {
      EXPECT_EQ(error.kind(), IoError::Kind::kMalformed);
      return std::nullopt;
    }
  }

  test::TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(, LazDamage, testing::ValuesIn(damage_kinds()),
                         [](const auto& kind) { return kind.param.name; });

// The numbers of points that a damaged header gives; the file may be read by either.
std::vector<std::size_t> numbers_in_header(const std::string& laz) {
  std::vector<std::size_t> numbers = {load<std::uint32_t>(laz.data() + kLegacyNumPointsAt)};
  if (laz.size() >= kNumPointsAt + 8) numbers.push_back(load<std::uint64_t>(laz.data() + kNumPointsAt));
  return numbers;
}

TEST_P(LazDamage, TruncationAnywhereLeavesWholeChunksAndCountsTheOthersOrIsAnError) {
  const std::string whole = bytes();
  ASSERT_EQ(num_accounted(whole), kNumPoints);
  std::size_t num_read = 0;
  for (std::size_t size = whole.size(); size-- > 0;) {
    const std::optional<std::size_t> num_points = num_accounted(std::string_view(whole).substr(0, size));
    if (!num_points) continue;
    ++num_read;
    ASSERT_EQ(*num_points, kNumPoints) << size;
    ASSERT_FALSE(read_las(folder_ / "a.laz").findings.empty()) << size;
  }
  EXPECT_EQ(num_read > 0, GetParam().can_be_cut);
}

TEST_P(LazDamage, EveryFlippedByteIsAnErrorOrTheHeadersNumberOfPoints) {
  const std::string whole = bytes();
  std::size_t num_refused = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const unsigned flip : {0xffU, 0x01U, 0x80U}) {
      if (test::kIsSanitized && flip != (at % 2 == 0 ? 0xffU : 0x01U)) continue;
      std::string laz = whole;
      laz[at] = static_cast<char>(static_cast<unsigned char>(laz[at]) ^ flip);
      const std::optional<std::size_t> num_points = num_accounted(laz);
      if (!num_points) {
        ++num_refused;
        continue;
      }
      const std::vector<std::size_t> numbers = numbers_in_header(laz);
      ASSERT_TRUE(std::ranges::count(numbers, *num_points) > 0)
          << "byte " << at << " ^ " << flip << ": " << *num_points;
    }
  }
  EXPECT_GT(num_refused, 0U);
}

class LazFaults : public testing::Test {
 protected:
  ReadResult read(std::string_view laz) const { return read_las(write_raw(folder_ / "a.laz", laz)); }
  static std::size_t points_at(const std::string& laz) { return load<std::uint32_t>(laz.data() + kPointsOffsetAt); }

  test::TemporaryFolder folder_;
};

TEST_F(LazFaults, ADamagedChunkIsLeftOutWholeAndNamed) {
  for (const unsigned format : {1, 6}) {
    const std::string las = random_las(format, 3000, 0, 4);
    std::string laz = compress_las(las, {.points_per_chunk = 1000, .chunk_sizes = {}});
    const ReadResult whole = read(laz);
    laz[laz.size() / 2] = static_cast<char>(laz[laz.size() / 2] ^ 0x55);
    const ReadResult damaged = read(laz);
    ASSERT_EQ(damaged.cloud.size(), 2000U);
    EXPECT_EQ(damaged.dropped.size(), 1000U);
    EXPECT_EQ(damaged.dropped.front(), 1000U);
    EXPECT_EQ(damaged.cloud.positions[999], whole.cloud.positions[999]);
    EXPECT_EQ(damaged.cloud.positions[1000], whole.cloud.positions[2000]);
    ASSERT_EQ(damaged.findings.size(), 1U);
    EXPECT_EQ(damaged.findings[0].count, 1000U);
    EXPECT_EQ(damaged.findings[0].what, "points of damaged LAZ chunks left out");
    EXPECT_NE(damaged.findings[0].first.find("chunk 2 at byte "), std::string::npos) << damaged.findings[0].first;
    EXPECT_TRUE(damaged.findings[0].is_damage);
  }
}

TEST_F(LazFaults, ATruncatedFileGivesItsWholeChunks) {
  for (const unsigned format : {3, 7}) {
    const std::string laz = compress_las(random_las(format, 3000, 0, 5), {.points_per_chunk = 1000, .chunk_sizes = {}});
    const ReadResult whole = read(laz);
    const ReadResult cut =
        read(std::string_view(laz).substr(0, points_at(laz) + (laz.size() - points_at(laz)) * 5 / 6));
    ASSERT_EQ(cut.cloud.size(), 2000U);
    EXPECT_TRUE(std::equal(cut.cloud.positions.begin(), cut.cloud.positions.end(), whole.cloud.positions.begin()));
    ASSERT_EQ(cut.findings.size(), 2U);
    EXPECT_EQ(cut.findings[1].text(),
              "1000 points are missing that the header counts (first: the file ends after point 2000)");
  }
}

// What the header claims is not allocated: see the limit of memory under which fuzzing runs.
TEST_F(LazFaults, AHeaderThatClaimsFourBillionPointsCostsNothing) {
  for (const unsigned version : {1, 2}) {
    std::string laz =
        compress_las(random_las(0, 10, 0, 6), {.version = version, .is_chunked = version == 2, .chunk_sizes = {}});
    laz.replace(kLegacyNumPointsAt, 4, "\xf0\xff\xff\xff");
    const std::string error = test::io_error_of([&] { read(laz); });
    EXPECT_EQ(error.substr(0, 29), "a.laz: no point can be read: ") << error;
  }
  std::string layered = compress_las(random_las(6, 10, 0, 6));
  layered.replace(kNumPointsAt, 8, "\xf0\xff\xff\xff\xff\xff\xff\x7f");
  const ReadResult result = read(layered);
  EXPECT_EQ(result.cloud.size(), 10U);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].count, 0x7ffffffffffffff0 - 10U);
}

TEST_F(LazFaults, AHeaderWithoutANumberIsReadByTheChunks) {
  std::string layered = compress_las(random_las(6, 2500, 0, 6), {.points_per_chunk = 1000, .chunk_sizes = {}});
  layered.replace(kNumPointsAt, 8, 8, '\0');
  EXPECT_EQ(read(layered).cloud.size(), 2500U);
  EXPECT_EQ(read(layered).findings.at(0).text(), "2500 points read that the header does not count");

  std::string pointwise = compress_las(random_las(1, 2500, 0, 6), {.points_per_chunk = 1000, .chunk_sizes = {}});
  pointwise.replace(kLegacyNumPointsAt, 4, 4, '\0');
  const ReadResult result = read(pointwise);
  EXPECT_EQ(result.cloud.size(), 2000U);
  ASSERT_EQ(result.findings.size(), 2U);
  EXPECT_EQ(result.findings[0].text(), "points of the last chunk left out: the header does not say how many they are");
}

TEST_F(LazFaults, AHeaderThatCountsTooFewIsBelieved) {
  std::string laz = compress_las(random_las(6, 2500, 0, 6), {.points_per_chunk = 1000, .chunk_sizes = {}});
  laz.replace(kNumPointsAt, 8, std::string("\xdc\x05\0\0\0\0\0\0", 8));
  const ReadResult result = read(laz);
  EXPECT_EQ(result.cloud.size(), 1500U);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].text(), "1000 points left out that the header does not count (first: point 1501)");
}

}  // namespace
}  // namespace vdbmap
