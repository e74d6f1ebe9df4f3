// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/las/wkt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "vdbmap/io/file/text.h"

namespace vdbmap {
namespace {

constexpr std::array<std::string_view, 3> kProjected = {"PROJCS", "PROJCRS", "PROJECTEDCRS"};
constexpr std::array<std::string_view, 5> kGeographic = {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS",
                                                         "GEODETICCRS"};
constexpr std::array<std::string_view, 1> kGeocentric = {"GEOCCS"};
constexpr std::array<std::string_view, 1> kCoordinateSystem = {"CS"};
constexpr std::array<std::string_view, 4> kWrappers = {"COMPD_CS", "COMPOUNDCRS", "BOUNDCRS", "SOURCECRS"};
constexpr std::array<std::string_view, 2> kIdentifiers = {"AUTHORITY", "ID"};
constexpr std::array<std::string_view, 2> kLengthUnits = {"UNIT", "LENGTHUNIT"};
constexpr std::array<std::string_view, 1> kAxis = {"AXIS"};

using Keywords = std::span<const std::string_view>;

// KEYWORD[body]
struct Node {
  std::string_view keyword;
  std::string_view body;
};

bool is_keyword(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }

std::string_view keyword_before(std::string_view text, std::size_t end) {
  std::size_t begin = end;
  while (begin > 0 && is_keyword(text[begin - 1])) --begin;
  return text.substr(begin, end - begin);
}

// The nodes of `text` that are in no other node of it.
std::vector<Node> outer_nodes(std::string_view text) {
  std::vector<Node> nodes;
  std::size_t depth = 0;
  std::size_t body_begin = 0;
  bool in_quotes = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if ((c == '[' || c == '(') && depth++ == 0) {
      nodes.push_back({keyword_before(text, i), {}});
      body_begin = i + 1;
    }
    if ((c == ']' || c == ')') && depth > 0 && --depth == 0)
      nodes.back().body = text.substr(body_begin, i - body_begin);
  }
  return nodes;
}

bool is_one_of(std::string_view keyword, Keywords keywords) { return std::ranges::count(keywords, keyword) > 0; }

std::optional<Node> find_node(const std::vector<Node>& nodes, Keywords keywords) {
  const auto found = std::ranges::find_if(nodes, [&](const Node& node) { return is_one_of(node.keyword, keywords); });
  return found == nodes.end() ? std::nullopt : std::optional(*found);
}

// A compound system holds the horizontal one, a bound system the one it is bound to.
std::optional<Node> find_in_wrappers(std::string_view wkt, Keywords keywords) {
  constexpr int kDeepestNesting = 4;
  std::string_view text = wkt;
  for (int depth = 0; depth < kDeepestNesting; ++depth) {
    const std::vector<Node> nodes = outer_nodes(text);
    if (auto found = find_node(nodes, keywords)) return found;
    const auto wrapper = find_node(nodes, kWrappers);
    if (!wrapper) return std::nullopt;
    text = wrapper->body;
  }
  return std::nullopt;
}

// Cuts the next of a node's values off, without its quotes.
std::string_view next_value(std::string_view& rest) {
  const std::size_t begin = std::min(rest.find_first_not_of(" \t\r\n"), rest.size());
  rest.remove_prefix(begin);
  const bool is_quoted = rest.starts_with('"');
  if (is_quoted) rest.remove_prefix(1);
  const std::string_view value = rest.substr(0, rest.find_first_of(is_quoted ? "\"" : ", \t\r\n"));
  const std::size_t comma = std::min(rest.find(',', value.size()), rest.size());
  rest.remove_prefix(std::min(comma + 1, rest.size()));
  return value;
}

// AUTHORITY["EPSG","25832"] or ID["EPSG",25832]
std::optional<int> epsg_of(const std::vector<Node>& children) {
  for (const Node& child : children) {
    if (!is_one_of(child.keyword, kIdentifiers)) continue;
    std::string_view rest = child.body;
    if (next_value(rest) != "EPSG") continue;
    const auto code = parse_count(next_value(rest));
    if (code && *code > 0 && *code < 1'000'000) return static_cast<int>(*code);
  }
  return std::nullopt;
}

// The factor of UNIT["foot",0.3048].
std::optional<double> metres_per_unit(const Node& unit) {
  std::string_view rest = unit.body;
  next_value(rest);  // the name
  const auto factor = parse_number(next_value(rest));
  return factor && std::isfinite(*factor) && *factor > 0 ? factor : std::nullopt;
}

// The unit stands directly in the system or, as newer texts have it, in its axes. No deeper: a foreign text may nest
// brackets without end.
std::optional<double> metres_per_unit_of(const std::vector<Node>& children) {
  if (const auto unit = find_node(children, kLengthUnits)) return metres_per_unit(*unit);
  const auto axis = find_node(children, kAxis);
  const auto unit = axis ? find_node(outer_nodes(axis->body), kLengthUnits) : std::nullopt;
  return unit ? metres_per_unit(*unit) : std::nullopt;
}

// Newer texts have one keyword for degrees and for axes through the centre of the earth.
CoordinateKind kind_of_geodetic(const std::vector<Node>& children) {
  const auto axes = find_node(children, kCoordinateSystem);
  const bool is_cartesian = axes && axes->body.starts_with("Cartesian");
  return is_cartesian ? CoordinateKind::kGeocentric : CoordinateKind::kGeographic;
}

}  // namespace

WktReferenceSystem parse_wkt(std::string_view wkt) {
  if (const auto projected = find_in_wrappers(wkt, kProjected)) {
    const std::vector<Node> children = outer_nodes(projected->body);
    return {epsg_of(children), metres_per_unit_of(children), CoordinateKind::kProjected};
  }
  if (const auto geographic = find_in_wrappers(wkt, kGeographic)) {
    const std::vector<Node> children = outer_nodes(geographic->body);
    return {epsg_of(children), {}, kind_of_geodetic(children)};
  }
  if (const auto geocentric = find_in_wrappers(wkt, kGeocentric)) {
    return {epsg_of(outer_nodes(geocentric->body)), {}, CoordinateKind::kGeocentric};
  }
  return {};
}

bool is_whole_wkt(std::string_view wkt) {
  int depth = 0;
  bool has_nodes = false;
  bool in_quotes = false;
  for (const char c : wkt) {
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == '[' || c == '(') ++depth;
    if ((c == ']' || c == ')') && --depth < 0) return false;
    has_nodes |= depth > 0;
  }
  return has_nodes && depth == 0 && !in_quotes;
}

}  // namespace vdbmap
