// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/points/class_filter.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "vdbmap/io/points/point_cloud_filter.h"

namespace vdbmap {
namespace {

[[noreturn]] void refuse_classes(const std::filesystem::path& file, const std::string& reason) {
  throw std::invalid_argument(file.string() + ": " + reason);
}

std::vector<std::int32_t> labels_of(const std::filesystem::path& file, const std::vector<std::string>& names,
                                    LabelScheme scheme) {
  if (scheme == LabelScheme::kUnknown) {
    refuse_classes(file, "does not say whose numbers its classes are, which leaves open which of them is " +
                             names.front() + "; --label-scheme says it");
  }
  std::vector<std::int32_t> labels;
  for (const std::string& name : names) {
    const std::vector<std::int32_t> named = labels_named(scheme, name);
    if (named.empty())
      refuse_classes(file, "has classes of " + std::string(text_of(scheme)) + ", none is \"" + name + "\"");
    labels.insert(labels.end(), named.begin(), named.end());
  }
  return labels;
}

}  // namespace

std::size_t drop_classes(const std::filesystem::path& file, ReadResult& read, const std::vector<std::string>& names,
                         std::optional<LabelScheme> scheme) {
  if (names.empty() || read.cloud.size() == 0) return 0;
  if (read.cloud.labels.empty()) {
    refuse_classes(file, "its points have no classes by which " + names.front() + " could be dropped");
  }
  const std::vector<std::int32_t> labels = labels_of(file, names, scheme.value_or(read.label_scheme));
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < read.cloud.size(); ++i) {
    if (std::ranges::find(labels, static_cast<std::int32_t>(read.cloud.labels[i])) != labels.end()) places.push_back(i);
  }
  drop_points(read, places);
  return places.size();
}

}  // namespace vdbmap
