// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/furniture.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace vdbmap::simulator {
namespace {

struct Thing {
  std::string name;
  std::function<void(const Brush&, const StandardMaterials&)> draw;
  Eigen::Vector3f size;  // [m] along the street, across it, and above ground, as such things measure
};

// GoogleTest prints parameters.
std::ostream& operator<<(std::ostream& stream, const Thing& thing) { return stream << thing.name; }

class Furniture : public testing::TestWithParam<Thing> {};

TEST_P(Furniture, HasItsRealSizeAndStandsOnTheGround) {
  const World world;
  Mesh mesh;
  GetParam().draw({&mesh}, world.standard());
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  const Eigen::Vector3f size(box.sizes().x(), box.sizes().y(), box.max().z());
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(size[axis], GetParam().size[axis], 0.1F) << axis;
  EXPECT_LE(box.min().z(), 0.01F);
  EXPECT_GE(box.min().z(), -0.31F);
}

INSTANTIATE_TEST_SUITE_P(
    All, Furniture,
    testing::Values(
        Thing{"Lamp", add_lamp, {0.28F, 1.6F, 5.95F}},
        Thing{"Sign",
              [](const Brush& b, const StandardMaterials& m) { add_sign(b, SignKind::kParking, m); },
              {0.06F, 0.6F, 2.7F}},
        Thing{"Bollard", add_bollard, {0.09F, 0.09F, 0.9F}},
        Thing{"Bin240Litres", [](const Brush& b, const StandardMaterials&) { add_bin(b, true); }, {0.8F, 0.6F, 1.07F}},
        Thing{"Bicycle",
              [](const Brush& b, const StandardMaterials& m) { add_bicycle(b, m.tyre); },
              {1.77F, 0.6F, 1.06F}},
        Thing{"Person",
              [](const Brush& b, const StandardMaterials&) { add_person(b, 1.75, 0, {}); },
              {0.26F, 0.6F, 1.75F}},
        Thing{"Shed",
              [](const Brush& b, const StandardMaterials&) {
                add_shed(b, {3, 5, 2.4}, 0, 0);
              },
              {3.3F, 5.3F, 2.55F}}),
    [](const testing::TestParamInfo<Thing>& test) { return test.param.name; });

}  // namespace
}  // namespace vdbmap::simulator
