// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/label_code.h"

#include <set>

#include <gtest/gtest.h>

namespace vdbmap {
namespace {

TEST(LabelCode, EveryNamedLabelComesBack) {
  for (const LabelScheme scheme : {LabelScheme::kAsprs, LabelScheme::kSemanticKitti}) {
    std::set<LabelCode> codes;
    for (std::int32_t label = 0; label < 300; ++label) {
      if (label_name(scheme, label) == "class " + std::to_string(label)) continue;
      EXPECT_EQ(label_of_code(scheme, code_of_label(scheme, label)), label);
      EXPECT_TRUE(codes.insert(code_of_label(scheme, label)).second) << label;
    }
    EXPECT_GT(codes.size(), 20U);
  }
}

TEST(LabelCode, LabelsThatHaveNoneAreOthers) {
  EXPECT_EQ(code_of_label(LabelScheme::kUnknown, 0), 0);
  EXPECT_EQ(label_of_code(LabelScheme::kUnknown, code_of_label(LabelScheme::kUnknown, 254)), 254);
  for (const std::int32_t label : {-1, 255, 256, 70'000}) {
    EXPECT_EQ(code_of_label(LabelScheme::kUnknown, label), kOtherLabelCode);
  }
  EXPECT_EQ(label_of_code(LabelScheme::kUnknown, kOtherLabelCode), std::nullopt);
}

}  // namespace
}  // namespace vdbmap
