// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vdbmap/io/map_inputs.h"
#include "vdbmap/store/city_manifest.h"

namespace vdbmap {

/// The name of an input's file, without its folder, and its turn.
std::string source_name(const MapInput& input);

/// What tells an input from others; see identify_sources().
MapSource identify_source(const MapInput& input);

/// What tells the inputs of a city apart, in their order: the names of their files without folders, and hashes of
/// content, turn and pose. The same scan at another pose is another source. Files are read once, in parallel;
/// on_file_done() is called after each, by any thread. Throws IoError for files that cannot be read.
std::vector<MapSource> identify_sources(
    const std::vector<MapInput>& inputs, const std::function<void()>& on_file_done = [] {});

}  // namespace vdbmap
