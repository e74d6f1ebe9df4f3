// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/App.hpp>

#include "parking/exchange/spaces_file.h"

namespace vdbmap::cli {

/// Declares --map-coordinates and --geoid-offset.
void add_geo_options(CLI::App& app, parking::GeoOptions& options);

}  // namespace vdbmap::cli
