// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/scans/scan_order.h"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

using Names = std::vector<std::string>;

// Sorted from several shuffled orders, which must not matter.
Names sorted(Names names) {
  std::mt19937 random(7);
  Names first;
  for (int round = 0; round < 5; ++round) {
    std::ranges::shuffle(names, random);
    std::ranges::sort(names, [](const std::string& a, const std::string& b) { return comes_before(a, b); });
    if (round == 0) first = names;
    EXPECT_EQ(names, first);
  }
  return names;
}

TEST(ScanOrder, FractionsCountByValue) {
  const Names times = {"0.05.bin", "0.1.bin", "0.25.bin", "0.5.bin", "1.bin", "1.05.bin", "9.99.bin", "10.05.bin"};
  EXPECT_EQ(sorted(times), times);
  const Names stamps = {"1403636579.05.pcd", "1403636579.763555.pcd", "1403636579.9.pcd", "1403636580.1.pcd"};
  EXPECT_EQ(sorted(stamps), stamps);
  const Names suffixed = {"scan_1.25_left.pcd.bin", "scan_1.5_left.pcd.bin", "scan_10.125_left.pcd.bin"};
  EXPECT_EQ(sorted(suffixed), suffixed);
}

TEST(ScanOrder, NumbersWithMorePointsAreVersionsOrDates) {
  const Names names = {"a.1.2.3.ply", "a.1.2.10.ply", "a.1.10.1.ply"};
  EXPECT_EQ(sorted(names), names);
  const Names dates = {"2023.12.31.ply", "2024.5.2.ply", "2024.05.11.ply"};
  EXPECT_EQ(sorted(dates), dates);
}

TEST(ScanOrder, WholeNumbersCountByValueWhateverTheirLength) {
  const Names names = {"1_5.pcd", "1_40.pcd", "1_0300.pcd", "2_1.pcd", "100000000000000000000.pcd"};
  EXPECT_EQ(sorted(names), names);
}

TEST(ScanOrder, NumbersMayBeNegativeWhereNoDashCanBeMeant) {
  const Names names = {"-10.5.bin", "-10.25.bin", "-2.bin", "0.bin", "3.bin"};
  EXPECT_EQ(sorted(names), names);
  const Names tiles = {"x_-20.bin", "x_-3.bin", "x_3.bin"};
  EXPECT_EQ(sorted(tiles), tiles);
  const Names dashed = {"scan-9.bin", "scan-10.bin"};
  EXPECT_EQ(sorted(dashed), dashed);
}

TEST(ScanOrder, LettersCountInEitherCase) {
  const Names names = {"scan_9.bin", "SCAN_10.BIN", "Scan_11.bin"};
  EXPECT_EQ(sorted(names), names);
}

TEST(ScanOrder, DecimalTextsOfAnyLengthAreOrderedAsNumbersAre) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> thousandths(-3000, 30000);
  std::vector<int> values;
  for (int i = 0; i < 200; ++i) values.push_back(thousandths(random));
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());

  Names names;  // with as many digits as each needs
  for (const int value : values) {
    std::string digits = std::to_string(1000 + std::abs(value) % 1000).substr(1);
    digits.erase(digits.find_last_not_of('0') + 1);
    names.push_back((value < 0 ? "-" : "") + std::to_string(std::abs(value) / 1000) +
                    (digits.empty() ? "" : "." + digits) + ".pcd");
  }
  EXPECT_EQ(sorted(names), names);
}

TEST(ScanOrder, IsStrictForNamesOfAllKinds) {
  const Names names = {"-",     "-1", "-a",   "_-1", "_-a", "_-", "1",  "1.", "1.5",
                       "1.5.5", "01", "1.50", "a",   "A",   "",   ".5", "a.5"};
  const auto before = [](const std::string& a, const std::string& b) { return comes_before(a, b); };
  for (const std::string& a : names) {
    EXPECT_FALSE(before(a, a));
    for (const std::string& b : names) {
      EXPECT_TRUE(a == b || before(a, b) != before(b, a)) << a << " " << b;
      for (const std::string& c : names) {
        EXPECT_TRUE(!before(a, b) || !before(b, c) || before(a, c)) << a << " " << b << " " << c;
      }
    }
  }
}

}  // namespace
}  // namespace vdbmap
