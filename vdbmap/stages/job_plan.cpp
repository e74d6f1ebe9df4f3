// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/stages/job_plan.h"

#include <limits>
#include <optional>
#include <stdexcept>

#include "vdbmap/core/error.h"
#include "vdbmap/io/points/point_fields.h"
#include "vdbmap/store/content_hash.h"
#include "vdbmap/store/json_field.h"

namespace vdbmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kJobName = "vdbmap job";

template <typename Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const Eigen::Isometry3d& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(pose(row, column));
  }
  return rows;
}

Json json_of(const PlannedSource& source) {
  const MapInput& input = source.input;
  Json json = {{"file", input.scan.file.string()}, {"bytes", source.num_bytes}};
  if (input.scan.turn) json["turn"] = *input.scan.turn;
  if (input.map_from_scan) json["map_from_scan"] = json_of(*input.map_from_scan);
  if (input.labels) json["labels"] = input.labels->string();
  return json;
}

Json json_of(const ReadOptions& read) {
  Json json = {{"strict", read.strict}};
  json["sensor"] = read.sensor ? Json(text_of(*read.sensor)) : Json(nullptr);
  json["columns"] = read.columns;
  json["bin_columns"] = read.bin_columns;
  json["bin_bits"] = read.bin_type ? Json(8 * size_of(*read.bin_type)) : Json(nullptr);
  return json;
}

// JSON has no infinity.
Json json_of(const std::optional<RangeLimits>& range) {
  if (!range) return nullptr;
  const bool has_end = range->max < std::numeric_limits<double>::infinity();
  return {range->min, has_end ? Json(range->max) : Json(nullptr)};
}

Json json_of(const BuildOptions& build) {
  const Eigen::Vector3d& anchor = build.anchor.value();
  return {{"voxel_sizes", build.voxel_sizes},
          {"anchor", {anchor.x(), anchor.y(), anchor.z()}},
          {"epsg", or_null(build.epsg)},
          {"epoch", or_null(build.epoch)}};
}

Json json_of(const LeftOutSource& source) { return {{"name", source.name}, {"reason", source.reason}}; }

template <typename Value>
std::string lines_of(const std::vector<Value>& values) {
  std::string text = "[";
  for (const Value& value : values) text += (&value == &values.front() ? "\n    " : ",\n    ") + json_of(value).dump();
  return text + (values.empty() ? "]" : "\n  ]");
}

Json head_of(const JobPlan& plan) {
  Json head = {{"format", kJobName}, {"version", kJobFormat}, {"city", plan.city.string()}, {"adds", plan.adds}};
  head["city_state"] = plan.city_state;
  head["build"] = json_of(plan.files.build);
  const std::optional<LabelScheme>& scheme = plan.files.inputs.label_scheme;
  head["label_scheme"] = scheme ? Json(std::string(text_of(*scheme))) : Json(nullptr);
  head["dropped_classes"] = plan.files.inputs.dropped_classes;
  head["read"] = json_of(plan.files.inputs.read);
  head["range"] = json_of(plan.files.inputs.range);
  head["density"] = plan.save.density;
  head["keep_epochs"] = plan.keep_epochs;
  head["keeps_parts"] = plan.keeps_parts;
  head["buckets"] = plan.num_buckets;
  return head;
}

std::vector<double> numbers_of(const JsonField& field, std::size_t count) {
  std::vector<double> numbers;
  for (const JsonField& element : field.elements()) numbers.push_back(element.number());
  if (numbers.size() != count) field.fail("has not " + std::to_string(count) + " numbers");
  return numbers;
}

std::vector<std::string> texts_of(const JsonField& field) {
  std::vector<std::string> texts;
  for (const JsonField& element : field.elements()) texts.push_back(element.text());
  return texts;
}

Eigen::Isometry3d pose_of_numbers(const JsonField& field) {
  const std::vector<double> numbers = numbers_of(field, 12);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 12; ++i) pose(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)];
  return pose;
}

PlannedSource planned_source(const JsonField& field) {
  // Field by field: GCC 12 destroys members of nested braces twice where a later one throws.
  PlannedSource source;
  source.input.scan.file = field.at("file").text();
  source.num_bytes = field.at("bytes").count();
  if (field.has("turn")) source.input.scan.turn = field.at("turn").count();
  if (field.has("map_from_scan")) source.input.map_from_scan = pose_of_numbers(field.at("map_from_scan"));
  if (field.has("labels")) source.input.labels = field.at("labels").text();
  return source;
}

ReadOptions read_options_of(const JsonField& field) {
  ReadOptions read;
  read.strict = field.at("strict").truth();
  if (!field.at("sensor").is_null()) {
    read.sensor = parse_sensor_choice(field.at("sensor").text());
    if (!read.sensor) field.at("sensor").fail("is no sensor");
  }
  read.columns = texts_of(field.at("columns"));
  read.bin_columns = texts_of(field.at("bin_columns"));
  if (!field.at("bin_bits").is_null()) {
    read.bin_type = field.at("bin_bits").count() == 64 ? ScalarType::kFloat64 : ScalarType::kFloat32;
  }
  return read;
}

std::optional<RangeLimits> range_of(const JsonField& field) {
  if (field.is_null()) return std::nullopt;
  const std::vector<JsonField> ends = field.elements();
  if (ends.size() != 2) field.fail("has not 2 ends");
  return RangeLimits{ends[0].number(), ends[1].is_null() ? std::numeric_limits<double>::infinity() : ends[1].number()};
}

BuildOptions build_options_of(const JsonField& field) {
  BuildOptions build;
  build.voxel_sizes.clear();
  for (const JsonField& size : field.at("voxel_sizes").elements()) build.voxel_sizes.push_back(size.number());
  build.anchor = field.at("anchor").point();
  if (!field.at("epsg").is_null()) build.epsg = field.at("epsg").integer();
  if (!field.at("epoch").is_null()) build.epoch = field.at("epoch").integer();
  try {
    build.check();
  } catch (const std::invalid_argument& error) {
    field.fail(std::string("cannot be: ") + error.what());
  }
  return build;
}

std::optional<LabelScheme> label_scheme_field(const JsonField& field) {
  if (field.is_null()) return std::nullopt;
  const std::optional<LabelScheme> scheme = label_scheme_of(field.text());
  if (!scheme) field.fail("is not known");
  return scheme;
}

// A mixer of bits whose outputs look random (Steele, Lea & Flood 2014, SplitMix64).
std::uint64_t mixed(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15U;
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111ebU;
  return bits ^ bits >> 31;
}

}  // namespace

std::string text_of(const JobPlan& plan) {
  try {
    std::string text = head_of(plan).dump(2);
    text.resize(text.size() - 2);  // the closing brace and its line
    text += ",\n  \"sources\": " + lines_of(plan.sources);
    return text + ",\n  \"left_out\": " + lines_of(plan.left_out) + "\n}\n";
  } catch (const nlohmann::json::type_error&) {
    throw std::invalid_argument("a plan can name only files whose names are UTF-8");
  }
}

JobPlan parse_job_plan(std::string_view text, const std::filesystem::path& path) {
  const Json json = parse_json(text, path);
  const JsonField root(json, "", path);
  root.check_format(kJobName, kJobFormat);
  JobPlan plan;
  plan.city = root.at("city").text();
  plan.adds = root.at("adds").truth();
  plan.city_state = root.at("city_state").text();
  plan.files.build = build_options_of(root.at("build"));
  plan.files.inputs.label_scheme = label_scheme_field(root.at("label_scheme"));
  plan.files.inputs.dropped_classes = texts_of(root.at("dropped_classes"));
  plan.files.inputs.read = read_options_of(root.at("read"));
  plan.files.inputs.range = range_of(root.at("range"));
  plan.save.density = static_cast<float>(root.at("density").number());
  plan.keep_epochs = root.at("keep_epochs").count();
  plan.keeps_parts = root.at("keeps_parts").truth();
  plan.num_buckets = root.at("buckets").count();
  if (plan.num_buckets == 0) root.at("buckets").fail("is 0");
  for (const JsonField& source : root.at("sources").elements()) plan.sources.push_back(planned_source(source));
  for (const JsonField& source : root.at("left_out").elements()) {
    plan.left_out.push_back({source.at("name").text(), source.at("reason").text()});
  }
  return plan;
}

std::size_t bucket_of(const TileId& tile, std::size_t num_buckets) {
  const auto x = static_cast<std::uint32_t>(tile.x);
  const auto y = static_cast<std::uint32_t>(tile.y);
  return static_cast<std::size_t>(mixed(std::uint64_t{x} << 32 | y) % num_buckets);
}

}  // namespace vdbmap
