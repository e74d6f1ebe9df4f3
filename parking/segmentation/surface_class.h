// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace vdbmap::parking {

/// What a voxel is part of, as the network tells it.
enum class SurfaceClass : std::uint8_t { kGround, kBuilding, kVegetation, kVehicle, kPole, kPerson, kOther };

inline constexpr std::size_t kNumClasses = 7;

/// "ground", "building", ...: as files of weights have it.
std::string_view name_of(SurfaceClass surface);

/// The class of SemanticKITTI that stands for it in a labelled map: road, building, vegetation, car, pole, person,
/// other object.
std::int32_t semantic_kitti_label(SurfaceClass surface);

/// What a class of SemanticKITTI falls into; nothing for those that say nothing (unlabelled, outlier, unknown ones).
std::optional<SurfaceClass> surface_class_of(std::int32_t semantic_kitti_label);

}  // namespace vdbmap::parking
