// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "vdbmap/store/city_manifest.h"

namespace vdbmap::cli {

/// What a city is by its manifest, a line a fact.
std::string text_of_city(const CityManifest& manifest);

/// The same for machines; what is unknown is null.
nlohmann::ordered_json json_of_city(const CityManifest& manifest, const std::filesystem::path& folder);

}  // namespace vdbmap::cli
