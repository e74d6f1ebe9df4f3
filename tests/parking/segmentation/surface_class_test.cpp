// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/surface_class.h"

#include <set>

#include <gtest/gtest.h>

#include "vdbmap/core/label_scheme.h"

namespace vdbmap::parking {
namespace {

TEST(SurfaceClass, StandsForItselfInSemanticKitti) {
  std::set<std::int32_t> labels;
  for (std::size_t i = 0; i < kNumClasses; ++i) {
    const auto surface = static_cast<SurfaceClass>(i);
    labels.insert(semantic_kitti_label(surface));
    EXPECT_EQ(surface_class_of(semantic_kitti_label(surface)), surface);
  }
  EXPECT_EQ(labels.size(), kNumClasses);
  EXPECT_EQ(label_name(LabelScheme::kSemanticKitti, semantic_kitti_label(SurfaceClass::kVehicle)), "car");
}

TEST(SurfaceClass, TakesRidersForPersonsAndWhatMovesForWhatStands) {
  EXPECT_EQ(surface_class_of(31), SurfaceClass::kPerson);      // bicyclist
  EXPECT_EQ(surface_class_of(252), SurfaceClass::kVehicle);    // moving car
  EXPECT_EQ(surface_class_of(71), SurfaceClass::kVegetation);  // trunk
  EXPECT_EQ(surface_class_of(0), std::nullopt);
  EXPECT_EQ(surface_class_of(1), std::nullopt);  // outlier
}

}  // namespace
}  // namespace vdbmap::parking
