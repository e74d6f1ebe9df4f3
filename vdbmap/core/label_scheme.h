// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vdbmap {

/// Whose numbers labels (classes of points and voxels) are. Of all schemes 0 says that a class is not known.
enum class LabelScheme {
  kUnknown,
  kAsprs,          ///< classifications of LAS files (ASPRS LAS 1.4 R15, table 17)
  kSemanticKitti,  ///< classes of SemanticKITTI's .label files (Behley et al. 2019)
};

/// The label of what has no class.
inline constexpr std::int32_t kNoLabel = 0;

/// "unknown", "asprs", "semantickitti".
std::string_view text_of(LabelScheme scheme);

/// The scheme of a text of text_of(), or nothing.
std::optional<LabelScheme> label_scheme_of(std::string_view text);

/// What a label stands for: "road", "no class"; "class 117" where the scheme does not say.
std::string label_name(LabelScheme scheme, std::int32_t label);

/// The labels of a name, those of what moves included: "person" is the moving person too. Empty where the scheme has
/// none.
std::vector<std::int32_t> labels_named(LabelScheme scheme, std::string_view name);

/// The ASPRS class that comes nearest to a label: 1 (unclassified) for what ASPRS has no class for, like vehicles.
/// Labels of an unknown scheme stay what they are.
std::int32_t asprs_label(LabelScheme scheme, std::int32_t label);

}  // namespace vdbmap
