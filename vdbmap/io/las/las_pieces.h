// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "vdbmap/io/points/point_reader.h"

namespace vdbmap {

/// Reads a large LAS or LAZ file piece by piece: together the pieces are the cloud that read_points() gives, one after
/// the other. What only all points tell, the scale of the colours and whether an attribute is known, is found in a
/// first walk through the file.
class LasPieces {
 public:
  /// A piece has `most_points` or less; of compressed points one chunk may have more. Nothing for other formats, files
  /// of no more than `most_points` or, compressed, twice as many, LAZ files in one chunk or with anything damaged, and
  /// those that have points which read_points() drops or coordinates that it judges as a whole: they must be read in
  /// one piece. Throws IoError as read_points() does.
  static std::optional<LasPieces> open(const std::filesystem::path& path, const ReadOptions& options,
                                       std::size_t most_points);
  ~LasPieces();
  LasPieces(LasPieces&&) noexcept;
  LasPieces& operator=(LasPieces&&) noexcept;

  /// The next piece; what was noticed in the file comes with each. To be called until is_at_end().
  ReadResult next();
  bool is_at_end() const;

 private:
  struct State;
  explicit LasPieces(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace vdbmap
