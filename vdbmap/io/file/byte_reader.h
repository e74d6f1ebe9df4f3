// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace vdbmap {

template <typename T>
concept Scalar = std::is_arithmetic_v<T> &&(sizeof(T) == 1 || sizeof(T) == 2 || sizeof(T) == 4 || sizeof(T) == 8);

/// Reverses the bytes of a number.
template <Scalar T>
T swap_bytes(T value) {
  if constexpr (sizeof(T) == 8) return std::bit_cast<T>(__builtin_bswap64(std::bit_cast<std::uint64_t>(value)));
  if constexpr (sizeof(T) == 4) return std::bit_cast<T>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
  if constexpr (sizeof(T) == 2) return std::bit_cast<T>(__builtin_bswap16(std::bit_cast<std::uint16_t>(value)));
  return value;
}

/// The number stored at `bytes`, which need not be aligned and must hold sizeof(T) bytes.
template <Scalar T, std::endian Order = std::endian::little>
T load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  if constexpr (Order != std::endian::native) return swap_bytes(value);
  return value;
}

/// The first `count` bytes of a file, or all where it is shorter. Throws IoError.
std::string read_front(const std::filesystem::path& path, std::uint64_t count);

/// Throws IoError unless `path` is a file that can be read more than once from its front: it is missing, a folder, a
/// pipe or a device. For readers that open it themselves.
void check_regular_file(const std::filesystem::path& path);

/// How the lines of a text end: LF, with or without a CR before it; or CR alone, as on old Macintoshes. The first end
/// decides.
char line_end_of(std::string_view text);

/// A file read from front to back. Whatever would leave the file throws IoError with path, offset and reason.
class ByteReader {
 public:
  /// When a file is read.
  enum class Loading {
    kWhole,     ///< at once: the memory taken is the size that the file system reports
    kOnDemand,  ///< as far as bytes() asks for it, until forget(); one thread at a time may use such a reader
  };

  /// Opens the file. Throws IoError.
  explicit ByteReader(std::filesystem::path path, Loading loading = Loading::kWhole);
  ~ByteReader();
  ByteReader(ByteReader&&) noexcept;
  ByteReader& operator=(ByteReader&&) noexcept;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }                 ///< [bytes] of the file
  std::uint64_t offset() const { return offset_; }             ///< [bytes] of the next read, from the front of the file
  std::uint64_t remaining() const { return size_ - offset_; }  ///< [bytes] from offset() to the end
  std::uint64_t line() const { return line_; }  ///< number of the line last returned by read_line(), from 1

  void seek(std::uint64_t offset);
  void skip(std::uint64_t count);

  /// The next `count` bytes; the view lives as long as the reader.
  std::string_view bytes(std::uint64_t count);

  /// Gives the memory back of the bytes before `end`, of a reader on demand; views of them are void.
  void forget_before(std::uint64_t end);

  /// The next number, little or big endian.
  template <Scalar T>
  T read_le() {
    return load<T, std::endian::little>(bytes(sizeof(T)).data());
  }
  template <Scalar T>
  T read_be() {
    return load<T, std::endian::big>(bytes(sizeof(T)).data());
  }

  /// The next line without its LF, CRLF or, where the first line of the file ends so, CR; the last line may lack it.
  /// Throws at the end of the file.
  std::string_view read_line();

  /// Throws IoError: "path: byte OFFSET: reason".
  [[noreturn]] void fail(const std::string& reason) const;
  /// Throws IoError about the line last read: "path:LINE: reason".
  [[noreturn]] void fail_line(const std::string& reason) const;

  /// Bytes of the file, wherever the next read is: of a reader on demand no others are read. The view lives as long as
  /// the reader, or until they are forgotten. The caller has checked that they are in the file.
  std::string_view bytes_at(std::uint64_t begin, std::uint64_t count) const { return view(begin, count); }

  /// All bytes of the file, wherever the next read is; the view lives as long as the reader.
  std::string_view all() const { return view(0, size_); }

 private:
  class PartsInMemory;

  std::string_view view(std::uint64_t begin, std::uint64_t count) const;

  std::filesystem::path path_;
  std::unique_ptr<char[]> data_;
  std::unique_ptr<PartsInMemory> parts_;  // instead of data_, on demand
  std::uint64_t size_ = 0;
  std::uint64_t offset_ = 0;
  std::uint64_t line_ = 0;
  char line_end_ = '\n';
};

}  // namespace vdbmap
