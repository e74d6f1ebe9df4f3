// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/render/label_colors.h"

#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

using Channels = std::tuple<int, int, int>;

Channels channels_of(LabelScheme scheme, std::int32_t label) {
  const Rgb8 color = label_color(scheme, label);
  return {color.r, color.g, color.b};
}

class LabelColors : public testing::TestWithParam<LabelScheme> {};

TEST_P(LabelColors, EveryClassHasOneOfItsOwn) {
  std::set<Channels> seen;
  int num_named = 0;
  for (std::int32_t label = 0; label < 300; ++label) {
    if (label_name(GetParam(), label).starts_with("class ")) continue;
    ++num_named;
    EXPECT_TRUE(seen.insert(channels_of(GetParam(), label)).second) << label_name(GetParam(), label);
  }
  EXPECT_GT(num_named, 20);
}

INSTANTIATE_TEST_SUITE_P(, LabelColors, testing::Values(LabelScheme::kAsprs, LabelScheme::kSemanticKitti));

TEST(LabelColorsOfNoScheme, DifferWhateverTheStepOfTheNumbers) {
  for (const int step : {1, 2, 10, 100}) {
    std::set<Channels> seen;
    for (std::int32_t i = 0; i < 30; ++i) seen.insert(channels_of(LabelScheme::kUnknown, i * step));
    EXPECT_EQ(seen.size(), 30U) << step;
  }
}

TEST(LabelColorsOfNoScheme, NoClassIsGrayAsInEveryScheme) {
  for (const LabelScheme scheme : {LabelScheme::kUnknown, LabelScheme::kAsprs, LabelScheme::kSemanticKitti}) {
    const auto [red, green, blue] = channels_of(scheme, kNoLabel);
    EXPECT_EQ(red, green);
    EXPECT_EQ(green, blue);
  }
}

}  // namespace
}  // namespace vdbmap
