// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/label_scheme.h"

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

TEST(LabelScheme, TextsComeBack) {
  for (const LabelScheme scheme : {LabelScheme::kUnknown, LabelScheme::kAsprs, LabelScheme::kSemanticKitti}) {
    EXPECT_EQ(label_scheme_of(text_of(scheme)), scheme);
  }
  EXPECT_EQ(label_scheme_of("cityscapes"), std::nullopt);
  EXPECT_EQ(label_scheme_of(""), std::nullopt);
}

// The numbers of the two publications.
TEST(LabelScheme, LabelsHaveTheNamesOfTheirScheme) {
  EXPECT_EQ(label_name(LabelScheme::kAsprs, 2), "ground");
  EXPECT_EQ(label_name(LabelScheme::kAsprs, 6), "building");
  EXPECT_EQ(label_name(LabelScheme::kAsprs, 40), "class 40");
  EXPECT_EQ(label_name(LabelScheme::kSemanticKitti, 40), "road");
  EXPECT_EQ(label_name(LabelScheme::kSemanticKitti, 252), "moving-car");
  EXPECT_EQ(label_name(LabelScheme::kSemanticKitti, 2), "class 2");
  EXPECT_EQ(label_name(LabelScheme::kUnknown, 40), "class 40");
  EXPECT_EQ(label_name(LabelScheme::kUnknown, -1), "class -1");
  for (const LabelScheme scheme : {LabelScheme::kUnknown, LabelScheme::kAsprs, LabelScheme::kSemanticKitti}) {
    EXPECT_EQ(label_name(scheme, kNoLabel), "no class");
  }
}

TEST(LabelScheme, EveryLabelHasAnAsprsClass) {
  EXPECT_EQ(asprs_label(LabelScheme::kSemanticKitti, 40), 11);  // road surface
  EXPECT_EQ(asprs_label(LabelScheme::kSemanticKitti, 50), 6);   // building
  EXPECT_EQ(asprs_label(LabelScheme::kSemanticKitti, 10), 1);   // a car is unclassified
  EXPECT_EQ(asprs_label(LabelScheme::kAsprs, 17), 17);
  EXPECT_EQ(asprs_label(LabelScheme::kUnknown, 117), 117);
  for (std::int32_t label = 0; label < 300; ++label) EXPECT_LE(asprs_label(LabelScheme::kSemanticKitti, label), 22);
  EXPECT_EQ(asprs_label(LabelScheme::kSemanticKitti, kNoLabel), kNoLabel);
}

}  // namespace
}  // namespace vdbmap
