// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "parking/segmentation/network_weights.h"
#include "vdbmap/store/city_folder.h"

namespace vdbmap::parking {

/// How a city is labelled.
struct LabelCityOptions {
  std::int32_t tiles_at_once = 4;  ///< along each side of a block; memory is that of a block and of 24 m around it
  std::function<void(std::size_t num_tiles)> on_tiles_done = [](std::size_t) {};
};

/// Writes a city with the labels of label_map() on all voxels, its sources those of the first, into a folder that is
/// new or empty. Blocks of tiles are labelled one after the other, each with what the network sees around it. Throws
/// IoError as load_window() and CityWriter do, where the folder holds a city already, and where `city` is changed
/// meanwhile; std::invalid_argument as label_map().
CityManifest label_city(City& city, const std::filesystem::path& folder, const NetworkWeights& network,
                        const LabelCityOptions& options = {});

}  // namespace vdbmap::parking
