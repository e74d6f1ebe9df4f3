// SPDX-License-Identifier: GPL-3.0-or-later
#include "parking/segmentation/surface_class.h"

#include <algorithm>
#include <array>
#include <span>

namespace vdbmap::parking {
namespace {

// The same table as tools/training/classes.py; riders are persons, what moves falls to what stands.
constexpr auto kGround = std::to_array<std::int32_t>({40, 44, 48, 49, 60, 72});
constexpr auto kBuilding = std::to_array<std::int32_t>({50});
constexpr auto kVegetation = std::to_array<std::int32_t>({70, 71});
constexpr auto kVehicle = std::to_array<std::int32_t>({10, 13, 16, 18, 20, 252, 256, 257, 258, 259});
constexpr auto kPole = std::to_array<std::int32_t>({80, 81});
constexpr auto kPerson = std::to_array<std::int32_t>({30, 31, 32, 253, 254, 255});
constexpr auto kOther = std::to_array<std::int32_t>({99, 11, 15, 51, 52});

struct Row {
  std::string_view name;
  std::span<const std::int32_t> labels;  // the first one stands for it
};

constexpr std::array<Row, kNumClasses> kRows = {{{"ground", kGround},
                                                 {"building", kBuilding},
                                                 {"vegetation", kVegetation},
                                                 {"vehicle", kVehicle},
                                                 {"pole", kPole},
                                                 {"person", kPerson},
                                                 {"other", kOther}}};

}  // namespace

std::string_view name_of(SurfaceClass surface) { return kRows[static_cast<std::size_t>(surface)].name; }

std::int32_t semantic_kitti_label(SurfaceClass surface) {
  return kRows[static_cast<std::size_t>(surface)].labels.front();
}

std::optional<SurfaceClass> surface_class_of(std::int32_t semantic_kitti_label) {
  for (std::size_t i = 0; i < kNumClasses; ++i) {
    if (std::ranges::find(kRows[i].labels, semantic_kitti_label) != kRows[i].labels.end()) {
      return static_cast<SurfaceClass>(i);
    }
  }
  return std::nullopt;
}

}  // namespace vdbmap::parking
