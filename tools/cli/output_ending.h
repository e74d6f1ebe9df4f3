// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vdbmap::cli {

/// What a command writes into a file: its name for messages, and the endings that stand for it.
struct OutputKind {
  std::string name;                  ///< "an OpenVDB file"
  std::vector<std::string> endings;  ///< lower case, with the dot; the first is recommended
};

extern const OutputKind kMapKind;      ///< maps and channels
extern const OutputKind kPictureKind;  ///< pictures and plots
extern const OutputKind kPosesKind;    ///< KITTI and TUM trajectories
extern const OutputKind kPointsKind;   ///< points
extern const OutputKind kLabelsKind;   ///< classes of points
extern const OutputKind kJsonKind;     ///< reports
extern const OutputKind kGeoJsonKind;  ///< places
extern const OutputKind kTableKind;    ///< tables

/// Whether a name has one of the endings of a kind, in upper or lower case.
bool has_ending(const std::filesystem::path& output, const OutputKind& kind);

/// Throws std::invalid_argument where the ending of a name, in upper or lower case, is one that stands for another
/// format than the one written. A name without ending, or with one that stands for no format, is as good as any.
void check_ending(const std::filesystem::path& output, const OutputKind& kind);

}  // namespace vdbmap::cli
