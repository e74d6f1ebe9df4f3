// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/city_output.h"
#include "tools/cli/common_options.h"
#include "tools/cli/survey_rays.h"
#include "vdbmap/store/city_build.h"

namespace vdbmap::cli {

/// What is told of a city's survey beside its points.
struct CitySurvey {
  std::string date;
  std::optional<SurveyTrack> track;  ///< from where the points were measured, where that is known
};

/// Builds a city in the folder `output`, or adds to that of --into, and shows how far it is.
CityBuilt build_city_of(const std::vector<MapInput>& inputs, const std::vector<SourceReplacement>& replaced,
                        const MapFromFilesOptions& files, const SaveOptions& save, const CitySurvey& survey,
                        const std::filesystem::path& output, const CityOutput& city, const CommonOptions& common);

/// What "OLD=FILE" means: the points of a file, which is one scan, in place of the source OLD. Throws
/// std::invalid_argument for anything else.
SourceReplacement parse_replacement(const std::string& text, const ReadOptions& read);

/// Logs which inputs were not counted, as they are in the city already or twice among them, and which were not there to
/// be removed.
void warn_not_counted(const CityBuilt& built);

}  // namespace vdbmap::cli
