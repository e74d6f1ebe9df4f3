// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbmap/io/file/read_finding.h"
#include "vdbmap/io/points/point_fields.h"

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

/// Whether a number can be a value of a field: of rings and labels whole and in range, of colours in range. NaN can: it
/// is how tables say that a value is missing.
bool is_possible(const PointField& field, double number);

/// What the values of a field are: "a whole number from 0 to 65535".
std::string text_of_possible(const PointField& field);

}  // namespace vdbmap
