// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/pcd/lzf.h"

#include <random>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

// Random bytes out of `num_letters`: the fewer, the more repetition.
std::string random_bytes(std::size_t size, int num_letters, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> letter(0, num_letters - 1);
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(letter(random));
  return bytes;
}

TEST(Lzf, DecompressesWhatItCompressed) {
  for (const int num_letters : {1, 2, 16, 256}) {
    for (const std::size_t size : {0, 1, 2, 3, 4, 31, 32, 33, 264, 265, 1000, 20000}) {
      const std::string data = random_bytes(size, num_letters, 7);
      const std::string compressed = lzf_compress(data);
      EXPECT_LE(compressed.size(), size + size / 32 + 1);
      EXPECT_EQ(lzf_decompress(compressed, size), data) << size << " bytes of " << num_letters << " letters";
    }
  }
}

TEST(Lzf, ShrinksRepetition) { EXPECT_LT(lzf_compress(std::string(26400, 'a')).size(), 320u); }

TEST(Lzf, FollowsTheFormatOfLibLzf) {
  using namespace std::string_literals;
  EXPECT_EQ(lzf_decompress("\x02"s + "abc", 3), "abc");
  EXPECT_EQ(lzf_decompress("\x02"s + "abc" + "\x20\x02"s, 6), "abcabc");                 // 3 bytes from 3 before
  EXPECT_EQ(lzf_decompress("\x00"s + "a" + "\xe0\x05\x00"s, 15), std::string(15, 'a'));  // 14 bytes from 1 before
}

TEST(Lzf, RefusesDamage) {
  using namespace std::string_literals;
  EXPECT_FALSE(lzf_decompress("\x03"s + "abc", 4)) << "literals end early";
  EXPECT_FALSE(lzf_decompress("\x02"s + "abc", 2)) << "more than promised";
  EXPECT_FALSE(lzf_decompress("\x02"s + "abc", 4)) << "less than promised";
  EXPECT_FALSE(lzf_decompress("\x02"s + "abc" + "\x20"s, 6)) << "a copy ends early";
  EXPECT_FALSE(lzf_decompress("\x02"s + "abc" + "\xe0\x01"s, 13)) << "a long copy ends early";
  EXPECT_FALSE(lzf_decompress("\x02"s + "abc" + "\x20\x03"s, 6)) << "a copy from before the front";
  EXPECT_FALSE(lzf_decompress("\x02"s + "abc", 4'000'000'000)) << "more than 3 bytes can expand to";
}

TEST(Lzf, SurvivesRandomBytes) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const auto data = lzf_decompress(random_bytes(1 + seed % 97, 256, seed), seed % 301);
    EXPECT_EQ(data ? data->size() : seed % 301, seed % 301);
  }
}

}  // namespace
}  // namespace vdbmap
