// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/web/label_code.h"

namespace vdbmap {
namespace {

constexpr std::int32_t kFirstMoving = 252;
constexpr std::int32_t kLastMoving = 259;
constexpr std::int32_t kCodeOfFirstMoving = 240;

}  // namespace

LabelCode code_of_label(LabelScheme scheme, std::int32_t label) {
  const bool is_moving = scheme == LabelScheme::kSemanticKitti && label >= kFirstMoving && label <= kLastMoving;
  if (is_moving) return static_cast<LabelCode>(label - kFirstMoving + kCodeOfFirstMoving);
  return label >= 0 && label < kOtherLabelCode ? static_cast<LabelCode>(label) : kOtherLabelCode;
}

std::optional<std::int32_t> label_of_code(LabelScheme scheme, LabelCode code) {
  if (code == kOtherLabelCode) return std::nullopt;
  const bool is_moving = scheme == LabelScheme::kSemanticKitti && code >= kCodeOfFirstMoving;
  return is_moving ? code - kCodeOfFirstMoving + kFirstMoving : code;
}

}  // namespace vdbmap
