// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/class_filter.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vdbmap {
namespace {

// Points at (0, 0, 0), (1, 0, 0), ... with these labels.
ReadResult labelled(const std::vector<std::uint16_t>& labels, LabelScheme scheme = LabelScheme::kSemanticKitti) {
  ReadResult read;
  for (std::size_t i = 0; i < labels.size(); ++i) read.cloud.positions.emplace_back(static_cast<double>(i), 0, 0);
  read.cloud.labels = labels;
  read.label_scheme = scheme;
  return read;
}

TEST(ClassFilter, DropsTheClassesWhetherTheyMoveOrNot) {
  ReadResult read = labelled({40, 30, 254, 31, 10, 253, 252, 0});
  EXPECT_EQ(drop_classes("a.bin", read, {"person", "bicyclist"}, std::nullopt), 4U);
  EXPECT_EQ(read.cloud.labels, (std::vector<std::uint16_t>{40, 10, 252, 0}));
  ASSERT_EQ(read.cloud.size(), 4U);
  EXPECT_EQ(read.cloud.positions[1].x(), 4);
  EXPECT_EQ(read.dropped, (std::vector<std::size_t>{1, 2, 3, 5}));
}

TEST(ClassFilter, OnlyMovingOnesCanBeNamedToo) {
  ReadResult read = labelled({10, 252});
  EXPECT_EQ(drop_classes("a.bin", read, {"moving-car"}, std::nullopt), 1U);
  EXPECT_EQ(read.cloud.labels, (std::vector<std::uint16_t>{10}));
}

TEST(ClassFilter, NoNamesDropNothingOfAnyFile) {
  ReadResult read = labelled({}, LabelScheme::kUnknown);
  read.cloud.positions.resize(3);
  EXPECT_EQ(drop_classes("a.bin", read, {}, std::nullopt), 0U);
  EXPECT_EQ(read.cloud.size(), 3U);
}

std::string refusal(ReadResult read, const std::vector<std::string>& names, std::optional<LabelScheme> scheme = {}) {
  try {
    drop_classes("a.bin", read, names, scheme);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ClassFilter, WhatCannotBeToldIsRefused) {
  ReadResult bare = labelled({});
  bare.cloud.positions.resize(2);
  EXPECT_THAT(refusal(bare, {"person"}), testing::HasSubstr("a.bin: its points have no classes"));
  EXPECT_THAT(refusal(labelled({30}, LabelScheme::kUnknown), {"person"}), testing::HasSubstr("--label-scheme"));
  EXPECT_EQ(refusal(labelled({30}, LabelScheme::kUnknown), {"person"}, LabelScheme::kSemanticKitti), "");
  EXPECT_THAT(refusal(labelled({2}, LabelScheme::kAsprs), {"person"}), testing::HasSubstr("none is \"person\""));
  EXPECT_THAT(refusal(labelled({30}), {"person", "persn"}), testing::HasSubstr("none is \"persn\""));
}

}  // namespace
}  // namespace vdbmap
