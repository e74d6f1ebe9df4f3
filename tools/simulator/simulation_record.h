// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/simulator/survey_frame.h"

namespace vdbmap::simulator {

/// What writing the epochs leaves for those that follow, and for the files of all.
struct SimulationRecord {
  /// How an epoch's mapper displaced what it measured.
  struct MappedEpoch {
    int epoch;
    SurveyFrame frame;
  };
  /// The share of each space that a drive saw (visibility.h).
  struct SeenSpaces {
    int epoch;
    std::string sensor;
    std::vector<double> shares;
  };

  nlohmann::ordered_json drives = nlohmann::ordered_json::array();  ///< what the scanners were and how they drove
  std::vector<MappedEpoch> mapped;                                  ///< not of an ideal street
  std::vector<SeenSpaces> seen;                                     ///< not of an ideal street
};

}  // namespace vdbmap::simulator
