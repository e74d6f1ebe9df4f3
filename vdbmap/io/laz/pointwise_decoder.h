// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "vdbmap/io/laz/laszip_record.h"

namespace vdbmap::laz {

/// Decodes a chunk of LASzip's point-wise compressor: point formats 0 to 3, versions 1 and 2. The first point stands
/// there as it is, all others follow in one code, each as what changed from those before.
class PointwiseDecoder {
 public:
  /// [bytes] that a chunk has at least: the first point, and the code's first bytes.
  static std::size_t least_size(const LaszipRecord& laszip);

  /// `bytes` are those of the chunk, at least least_size(), or of more: they must outlive the decoder.
  PointwiseDecoder(const LaszipRecord& laszip, std::string_view bytes);
  ~PointwiseDecoder();
  PointwiseDecoder(PointwiseDecoder&&) noexcept;
  PointwiseDecoder& operator=(PointwiseDecoder&&) noexcept;

  /// Writes the next `count` points, as records of an uncompressed file.
  void decode(char* records, std::size_t count);

  bool is_beyond_end() const;    ///< the bytes end before the points that were decoded
  bool is_at_end() const;        ///< the bytes end with the points that were decoded
  std::size_t num_used() const;  ///< [bytes]

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vdbmap::laz
