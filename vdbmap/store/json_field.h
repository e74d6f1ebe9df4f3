// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace vdbmap {

/// Parses a JSON object. Throws IoError (malformed) for any other text.
nlohmann::ordered_json parse_json(std::string_view text, const std::filesystem::path& path);

/// A value in a JSON file. Whatever is not as it should be throws IoError (malformed): file, place, and reason. Refers
/// to the JSON and the path that it is given.
class JsonField {
 public:
  JsonField(const nlohmann::ordered_json& json, std::string name, const std::filesystem::path& path)
      : json_(json), name_(std::move(name)), path_(path) {}

  /// Says that the value cannot be: "map.json: tiles[3].x is ...".
  [[noreturn]] void fail(const std::string& reason) const;

  /// Checks the fields `format` and `version` of a file that says what it is.
  void check_format(const std::string& format, std::int32_t version) const;

  /// The same where versions from `oldest` on are known.
  void check_format(const std::string& format, std::int32_t oldest, std::int32_t version) const;

  bool has(const std::string& key) const { return json_.is_object() && json_.contains(key); }
  JsonField at(const std::string& key) const;
  std::vector<JsonField> elements() const;

  bool is_null() const { return json_.is_null(); }
  std::string text() const;
  bool truth() const;
  double number() const;
  std::uint64_t count() const;
  std::int32_t integer() const;
  Eigen::Vector3d point() const;

  /// Hexadecimal digits. They become parts of names of files: nothing else may come out of it.
  std::string hash(std::size_t size) const;

 private:
  std::string inner(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }

  const nlohmann::ordered_json& json_;
  std::string name_;
  const std::filesystem::path& path_;
};

}  // namespace vdbmap
