// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/store/json_field.h"

#include "vdbmap/core/error.h"

namespace vdbmap {

nlohmann::ordered_json parse_json(std::string_view text, const std::filesystem::path& path) {
  auto json = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) throw IoError::malformed(path, "is damaged: it is no JSON object");
  return json;
}

void JsonField::fail(const std::string& reason) const { throw IoError::malformed(path_, name_ + " " + reason); }

void JsonField::check_format(const std::string& format, std::int32_t version) const {
  check_format(format, version, version);
}

void JsonField::check_format(const std::string& format, std::int32_t oldest, std::int32_t version) const {
  if (at("format").text() != format) at("format").fail("is not '" + format + "'");
  const std::int32_t given = at("version").integer();
  if (oldest <= given && given <= version) return;
  at("version").fail("is " + std::to_string(given) + (given > version ? ", newer than" : ", expected") + " the " +
                     std::to_string(version) + " that this program knows");
}

JsonField JsonField::at(const std::string& key) const {
  if (!json_.is_object()) fail("is no object");
  const auto found = json_.find(key);
  if (found == json_.end()) throw IoError::malformed(path_, inner(key) + " is missing");
  return {*found, inner(key), path_};
}

std::vector<JsonField> JsonField::elements() const {
  if (!json_.is_array()) fail("is no list");
  std::vector<JsonField> fields;
  for (std::size_t i = 0; i < json_.size(); ++i) {
    fields.emplace_back(json_[i], name_ + "[" + std::to_string(i) + "]", path_);
  }
  return fields;
}

std::string JsonField::text() const {
  if (!json_.is_string()) fail("is no text");
  return json_.get<std::string>();
}

bool JsonField::truth() const {
  if (!json_.is_boolean()) fail("is neither true nor false");
  return json_.get<bool>();
}

double JsonField::number() const {
  if (!json_.is_number()) fail("is no number");
  return json_.get<double>();
}

std::uint64_t JsonField::count() const {
  if (!json_.is_number_unsigned()) fail("is no whole number from 0 on");
  return json_.get<std::uint64_t>();
}

std::int32_t JsonField::integer() const {
  const std::int64_t value = json_.is_number_integer() ? json_.get<std::int64_t>() : 0;
  if (!json_.is_number_integer() || value != static_cast<std::int32_t>(value)) fail("is no whole number of 32 bits");
  return static_cast<std::int32_t>(value);
}

Eigen::Vector3d JsonField::point() const {
  const std::vector<JsonField> axes = elements();
  if (axes.size() != 3) fail("has " + std::to_string(axes.size()) + " coordinates, expected 3");
  return {axes[0].number(), axes[1].number(), axes[2].number()};
}

std::string JsonField::hash(std::size_t size) const {
  const std::string digits = text();
  const bool is_hash = digits.size() == size && digits.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_hash) fail("is no hash of " + std::to_string(size) + " hexadecimal digits");
  return digits;
}

}  // namespace vdbmap
