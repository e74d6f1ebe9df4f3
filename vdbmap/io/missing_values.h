// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/point_fields.h"
#include "vdbmap/io/read_finding.h"

namespace vdbmap {

/// Values of a text that a point can do without and that cannot be read, by field.
class MissingValues {
 public:
  /// `text` is what stands in place of a number.
  void add(std::size_t field, std::uint64_t line, std::string_view text, const std::string& reason);

  /// Takes the attributes off `cloud` of which no point has a value, and notes what is missing. It is damage unless all
  /// values of a field are, which is then of another kind, or marks as "N/A" say so.
  void finish(PointCloud& cloud, const std::vector<std::optional<PointField>>& fields,
              const std::vector<std::string>& names, std::vector<ReadFinding>& findings) const;

 private:
  struct OfField {
    std::size_t count = 0;
    std::string first;
    bool has_damage = false;
  };
  std::map<std::size_t, OfField> of_field_;
};

/// What keeps a number from being a value of a field: nothing, or that it is not whole or out of range. NaN is a value:
/// it is how tables say that one is missing.
std::optional<std::string> reason_against(const PointField& field, double number);

}  // namespace vdbmap
