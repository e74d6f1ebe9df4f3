// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/large_allocator.h"

#include <cstdint>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

TEST(LargeAllocator, KeepsValuesWhileAVectorGrowsFromSmallToLarge) {
  LargeVector<std::uint32_t> values;
  for (std::uint32_t i = 0; i < 3'000'000; ++i) values.push_back(i);
  for (std::uint32_t i = 0; i < 3'000'000; ++i) ASSERT_EQ(values[i], i);
  values.resize(10);
  values.shrink_to_fit();
  EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0U), 45U);
}

TEST(LargeAllocator, LargeArraysBeginOnAHugePage) {
  for (const std::size_t bytes : {2 * kHugePage, 2 * kHugePage + 1, 7 * kHugePage - 1}) {
    LargeVector<char> values(bytes, 'x');
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(values.data()) % kHugePage, 0U);
    EXPECT_EQ(values.back(), 'x');
  }
}

TEST(LargeAllocator, ClassesWithValuesOfTheirOwnBeginWithThem) {
  struct Counter {
    int count = 7;
  };
  EXPECT_EQ(LargeVector<Counter>(2'000'000).back().count, 7);
  EXPECT_EQ(LargeVector<Counter>(3).back().count, 7);
}

TEST(LargeAllocator, WhatCannotBeHadIsRefused) {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW(LargeAllocator<std::uint64_t>().allocate(kMost), std::bad_array_new_length);
  EXPECT_THROW(LargeAllocator<std::uint64_t>().allocate(kMost / 8), std::bad_alloc);
  EXPECT_THROW(LargeAllocator<char>().allocate(kMost / 4), std::bad_alloc);
}

}  // namespace
}  // namespace vdbmap
