// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/byte_reader.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      // Without O_NONBLOCK opening a named pipe would wait for its writer.
      : value_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    if (value_ < 0) throw IoError::system(path, "cannot open", errno);
  }
  ~Descriptor() { ::close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int value() const { return value_; }

 private:
  int value_;
};

std::uint64_t size_of_regular_file(const Descriptor& file, const std::filesystem::path& path) {
  struct stat status {};
  if (::fstat(file.value(), &status) != 0) throw IoError::system(path, "cannot read", errno);
  if (S_ISDIR(status.st_mode)) throw IoError::system(path, "cannot read", EISDIR);
  if (!S_ISREG(status.st_mode)) throw IoError::malformed(path, "not a regular file");
  return static_cast<std::uint64_t>(status.st_size);
}

void read_bytes(const Descriptor& file, const std::filesystem::path& path, char* data, std::uint64_t size) {
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t count = ::read(file.value(), data + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw IoError::system(path, "cannot read", errno);
    if (count == 0) throw IoError::malformed_at_byte(path, done, "the file shrank while it was read");
    done += static_cast<std::uint64_t>(count);
  }
}

}  // namespace

void check_regular_file(const std::filesystem::path& path) { size_of_regular_file(Descriptor(path), path); }

std::string read_front(const std::filesystem::path& path, std::uint64_t count) {
  const Descriptor file(path);
  std::string front(std::min(count, size_of_regular_file(file, path)), '\0');
  read_bytes(file, path, front.data(), front.size());
  return front;
}

char line_end_of(std::string_view text) {
  const std::size_t at = text.find_first_of("\r\n");
  const bool is_bare_return = at != std::string_view::npos && text[at] == '\r' && text.substr(at + 1, 1) != "\n";
  return is_bare_return ? '\r' : '\n';
}

ByteReader::ByteReader(std::filesystem::path path) : path_(std::move(path)) {
  const Descriptor file(path_);
  size_ = size_of_regular_file(file, path_);
  data_ = std::make_unique_for_overwrite<char[]>(size_);
  read_bytes(file, path_, data_.get(), size_);
}

void ByteReader::seek(std::uint64_t offset) {
  if (offset > size_) fail("byte " + std::to_string(offset) + " lies beyond the end at " + std::to_string(size_));
  offset_ = offset;
}

void ByteReader::skip(std::uint64_t count) { bytes(count); }

std::string_view ByteReader::bytes(std::uint64_t count) {
  if (count > remaining()) {
    fail("the file ends too early: expected " + std::to_string(count) + " more bytes, found " +
         std::to_string(remaining()));
  }
  const std::string_view view(data_.get() + offset_, count);
  offset_ += count;
  return view;
}

std::string_view ByteReader::read_line() {
  if (remaining() == 0) fail("the file ends too early: expected another line");
  const std::string_view rest(data_.get() + offset_, remaining());
  if (offset_ == 0) line_end_ = line_end_of(rest);
  const std::size_t length = rest.find(line_end_);
  std::string_view line = rest.substr(0, length);
  offset_ += length == std::string_view::npos ? rest.size() : length + 1;
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++line_;
  return line;
}

void ByteReader::fail(const std::string& reason) const { throw IoError::malformed_at_byte(path_, offset_, reason); }

void ByteReader::fail_line(const std::string& reason) const { throw IoError::malformed_at_line(path_, line_, reason); }

}  // namespace vdbmap
