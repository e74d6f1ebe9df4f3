// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vdbmap/core/error.h"
#include "vdbmap/io/file/byte_reader.h"

namespace vdbmap::test {

/// The bytes of a whole file, read without the library.
std::string read_raw(const std::filesystem::path& path);

/// Writes a whole file without the library and without waiting for the disk; returns its path.
std::filesystem::path write_raw(const std::filesystem::path& path, std::string_view bytes);

/// Numbers one after the other as bytes of a file.
template <std::endian Order = std::endian::little, typename... Numbers>
std::string raw(Numbers... numbers) {
  std::string bytes;
  const auto append = [&bytes](auto number) {
    if constexpr (Order != std::endian::native) number = swap_bytes(number);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
  };
  (append(numbers), ...);
  return bytes;
}

/// What the IoError says that `action` throws, without the folder of the file; "no error" where it throws none.
template <typename Action>
std::string io_error_of(Action&& action) {
  try {
    action();
  } catch (const IoError& error) {
    const std::string message = error.what();
    return message.substr(message.rfind('/', message.find(": ")) + 1);
  }
  return "no error";
}

}  // namespace vdbmap::test
