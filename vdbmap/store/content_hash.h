// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

struct XXH3_state_s;

namespace vdbmap {

/// The XXH3 hash of 128 bits of what is added, as 32 hexadecimal digits.
class ContentHash {
 public:
  static constexpr std::size_t kNumDigits = 32;

  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(const void* bytes, std::size_t size);
  std::string digits() const;

 private:
  XXH3_state_s* state_;
};

std::string hash_of_bytes(std::string_view bytes);

/// Throws IoError (system) where the file cannot be read.
std::string hash_of_file(const std::filesystem::path& path);

}  // namespace vdbmap
