// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulator/survey.h"

namespace vdbmap::simulator {
namespace {

template <typename Value>
void append_to(std::vector<Value>& values, const std::vector<Value>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

}  // namespace

void Survey::append(const Survey& other) {
  append_to(cloud.positions, other.cloud.positions);
  append_to(cloud.colors, other.cloud.colors);
  append_to(cloud.intensities, other.cloud.intensities);
  append_to(cloud.times, other.cloud.times);
  append_to(cloud.rings, other.cloud.rings);
  append_to(truth, other.truth);
}

}  // namespace vdbmap::simulator
