// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

#include "vdbmap/io/points/coordinate_kind.h"

namespace vdbmap {

/// What well-known text (OGC 01-009 and its successor 18-010) says about horizontal coordinates; nothing where it does
/// not, however malformed. Time and memory follow the length of the text: no bracket deeper than six within each other
/// is looked into.
struct WktReferenceSystem {
  std::optional<int> epsg;                ///< of the projected system, else of the geographic one
  std::optional<double> metres_per_unit;  ///< of the projected system
  CoordinateKind kind = CoordinateKind::kUnknown;
};

WktReferenceSystem parse_wkt(std::string_view wkt);

/// Whether a text has nodes, and all of its brackets and quotes are closed.
bool is_whole_wkt(std::string_view wkt);

}  // namespace vdbmap
