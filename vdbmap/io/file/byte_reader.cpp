// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/byte_reader.h"

#include <algorithm>
#include <cerrno>
#include <new>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
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
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int value() const { return value_; }

  // From here on somebody else closes it.
  int release() { return std::exchange(value_, -1); }

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

void read_bytes(int file, const std::filesystem::path& path, char* data, std::uint64_t size, std::uint64_t offset = 0) {
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t count = ::pread(file, data + done, size - done, static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw IoError::system(path, "cannot read", errno);
    if (count == 0) throw IoError::malformed_at_byte(path, offset + done, "the file shrank while it was read");
    done += static_cast<std::uint64_t>(count);
  }
}

}  // namespace

void check_regular_file(const std::filesystem::path& path) { size_of_regular_file(Descriptor(path), path); }

std::string read_front(const std::filesystem::path& path, std::uint64_t count) {
  const Descriptor file(path);
  std::string front(std::min(count, size_of_regular_file(file, path)), '\0');
  read_bytes(file.value(), path, front.data(), front.size());
  return front;
}

char line_end_of(std::string_view text) {
  const std::size_t at = text.find_first_of("\r\n");
  const bool is_bare_return = at != std::string_view::npos && text[at] == '\r' && text.substr(at + 1, 1) != "\n";
  return is_bare_return ? '\r' : '\n';
}

// Addresses for the whole file, of which the kernel gives memory to those parts that were read.
class ByteReader::PartsInMemory {
 public:
  PartsInMemory(Descriptor&& file, std::uint64_t size) : file_(file.release()), size_(size) {
    if (size == 0) return;
    void* const memory =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<char*>(memory);
    ::madvise(data_, size, MADV_HUGEPAGE);  // a wish: fewer faults where parts are read
    is_read_.resize((size + kPartSize - 1) / kPartSize);
  }
  ~PartsInMemory() {
    ::close(file_);
    if (data_) ::munmap(data_, size_);
  }
  PartsInMemory(const PartsInMemory&) = delete;
  PartsInMemory& operator=(const PartsInMemory&) = delete;

  const char* read(const std::filesystem::path& path, std::uint64_t begin, std::uint64_t count) {
    for (std::uint64_t part = begin / kPartSize; part * kPartSize < begin + count; ++part) {
      if (is_read_[part]) continue;
      const std::uint64_t offset = part * kPartSize;
      read_bytes(file_, path, data_ + offset, std::min(kPartSize, size_ - offset), offset);
      is_read_[part] = true;
    }
    return data_ + begin;
  }

  void forget_before(std::uint64_t end) {
    for (std::uint64_t part = 0; (part + 1) * kPartSize <= end; ++part) {
      if (is_read_[part]) ::madvise(data_ + part * kPartSize, kPartSize, MADV_DONTNEED);
      is_read_[part] = false;
    }
  }

 private:
  static constexpr std::uint64_t kPartSize = std::uint64_t{2} << 20;  // [bytes] as large as a huge page

  int file_;
  std::uint64_t size_;
  char* data_ = nullptr;
  std::vector<bool> is_read_;
};

ByteReader::ByteReader(std::filesystem::path path, Loading loading) : path_(std::move(path)) {
  Descriptor file(path_);
  size_ = size_of_regular_file(file, path_);
  if (loading == Loading::kOnDemand) {
    parts_ = std::make_unique<PartsInMemory>(std::move(file), size_);
    return;
  }
  data_ = std::make_unique_for_overwrite<char[]>(size_);
  read_bytes(file.value(), path_, data_.get(), size_);
}

ByteReader::~ByteReader() = default;
ByteReader::ByteReader(ByteReader&&) noexcept = default;
ByteReader& ByteReader::operator=(ByteReader&&) noexcept = default;

std::string_view ByteReader::view(std::uint64_t begin, std::uint64_t count) const {
  return {parts_ ? parts_->read(path_, begin, count) : data_.get() + begin, count};
}

void ByteReader::forget_before(std::uint64_t end) {
  if (parts_) parts_->forget_before(std::min(end, size_));
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
  const std::string_view found = view(offset_, count);
  offset_ += count;
  return found;
}

std::string_view ByteReader::read_line() {
  if (remaining() == 0) fail("the file ends too early: expected another line");
  const std::string_view rest = view(offset_, remaining());
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
