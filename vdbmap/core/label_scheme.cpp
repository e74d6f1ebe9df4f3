// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/label_scheme.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace vdbmap {
namespace {

using LabelName = std::pair<std::int32_t, std::string_view>;

constexpr std::array kSchemes = {LabelScheme::kUnknown, LabelScheme::kAsprs, LabelScheme::kSemanticKitti};

constexpr auto kAsprsNames = std::to_array<LabelName>({
    {1, "unclassified"},
    {2, "ground"},
    {3, "low vegetation"},
    {4, "medium vegetation"},
    {5, "high vegetation"},
    {6, "building"},
    {7, "low noise"},
    {8, "model key-point"},
    {9, "water"},
    {10, "rail"},
    {11, "road surface"},
    {12, "overlap"},
    {13, "wire guard"},
    {14, "wire conductor"},
    {15, "transmission tower"},
    {16, "wire connector"},
    {17, "bridge deck"},
    {18, "high noise"},
    {19, "overhead structure"},
    {20, "ignored ground"},
    {21, "snow"},
    {22, "temporal exclusion"},
});

constexpr auto kSemanticKittiNames = std::to_array<LabelName>({
    {1, "outlier"},
    {10, "car"},
    {11, "bicycle"},
    {13, "bus"},
    {15, "motorcycle"},
    {16, "on-rails"},
    {18, "truck"},
    {20, "other-vehicle"},
    {30, "person"},
    {31, "bicyclist"},
    {32, "motorcyclist"},
    {40, "road"},
    {44, "parking"},
    {48, "sidewalk"},
    {49, "other-ground"},
    {50, "building"},
    {51, "fence"},
    {52, "other-structure"},
    {60, "lane-marking"},
    {70, "vegetation"},
    {71, "trunk"},
    {72, "terrain"},
    {80, "pole"},
    {81, "traffic-sign"},
    {99, "other-object"},
    {252, "moving-car"},
    {253, "moving-bicyclist"},
    {254, "moving-person"},
    {255, "moving-motorcyclist"},
    {256, "moving-on-rails"},
    {257, "moving-bus"},
    {258, "moving-truck"},
    {259, "moving-other-vehicle"},
});

std::span<const LabelName> names_of(LabelScheme scheme) {
  if (scheme == LabelScheme::kAsprs) return kAsprsNames;
  if (scheme == LabelScheme::kSemanticKitti) return kSemanticKittiNames;
  return {};
}

}  // namespace

std::string_view text_of(LabelScheme scheme) {
  switch (scheme) {
    case LabelScheme::kAsprs:
      return "asprs";
    case LabelScheme::kSemanticKitti:
      return "semantickitti";
    case LabelScheme::kUnknown:
      break;
  }
  return "unknown";
}

std::optional<LabelScheme> label_scheme_of(std::string_view text) {
  const auto found = std::ranges::find(kSchemes, text, text_of);
  return found == kSchemes.end() ? std::nullopt : std::optional(*found);
}

std::int32_t asprs_label(LabelScheme scheme, std::int32_t label) {
  if (scheme != LabelScheme::kSemanticKitti || label == kNoLabel) return label;
  switch (label) {
    case 48:  // sidewalk
    case 49:  // other ground
    case 72:  // terrain
      return 2;
    case 70:  // vegetation
    case 71:  // trunk
      return 5;
    case 50:  // building
      return 6;
    case 1:  // outlier
      return 7;
    case 40:  // road
    case 44:  // parking
    case 60:  // lane marking
      return 11;
    default:
      return 1;
  }
}

std::string label_name(LabelScheme scheme, std::int32_t label) {
  if (label == kNoLabel) return "no class";
  const std::span<const LabelName> names = names_of(scheme);
  const auto found = std::ranges::find(names, label, &LabelName::first);
  return found == names.end() ? "class " + std::to_string(label) : std::string(found->second);
}

std::vector<std::int32_t> labels_named(LabelScheme scheme, std::string_view name) {
  constexpr std::string_view kMoving = "moving-";
  std::vector<std::int32_t> labels;
  for (const auto& [label, text] : names_of(scheme)) {
    if (text == name || (text.starts_with(kMoving) && text.substr(kMoving.size()) == name)) labels.push_back(label);
  }
  return labels;
}

}  // namespace vdbmap
