// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/io/file/line_reader.h"

#include <cerrno>
#include <utility>

#include "vdbmap/core/error.h"

namespace vdbmap {
namespace {

constexpr int kEnd = -1;
constexpr std::size_t kReadSize = std::size_t{1} << 16;  // [bytes]

}  // namespace

LineReader::LineReader(std::filesystem::path path) : path_(std::move(path)), file_(path_, std::ios::binary) {
  if (!file_) throw IoError::system(path_, "cannot open", errno);
  buffer_.resize(kReadSize);
}

// The next byte, or kEnd. The stream would take memory that is refused inside of it for the end of the file: so it
// fills a buffer that is there.
int LineReader::get() {
  if (at_ == end_) {
    file_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (file_.bad()) throw IoError::system(path_, "cannot read", errno);
    at_ = 0;
    end_ = static_cast<std::size_t>(file_.gcount());
    if (end_ == 0) return kEnd;
  }
  return static_cast<unsigned char>(buffer_[at_++]);
}

void LineReader::begin() {
  constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
  if (get() == kEnd) return;
  at_ = 0;
  const std::string_view front(buffer_.data(), end_);
  if (front.starts_with("\xFF\xFE") || front.starts_with("\xFE\xFF")) {
    throw IoError::malformed(path_, "is text in UTF-16, expected UTF-8");
  }
  if (front.starts_with(kUtf8Mark)) at_ = kUtf8Mark.size();
}

std::optional<std::string_view> LineReader::next() {
  if (number_ == 0) begin();
  line_.clear();
  ++number_;
  int byte = get();
  if (byte == '\n' && is_after_cr_) byte = get();  // the second half of the last line's end
  for (;; byte = get()) {
    is_after_cr_ = byte == '\r';
    if (byte == kEnd && line_.empty()) return std::nullopt;
    if (byte == kEnd || byte == '\n' || byte == '\r') return line_;
    if (line_.size() == kLongestLine) {
      throw IoError::malformed_at_line(path_, number_,
                                       "is longer than " + std::to_string(kLongestLine >> 20) + " MB: this is no text");
    }
    line_.push_back(static_cast<char>(byte));
  }
}

}  // namespace vdbmap
