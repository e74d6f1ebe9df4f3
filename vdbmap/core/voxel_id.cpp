// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_id.h"

#include <charconv>

namespace vdbmap {
namespace {

constexpr std::size_t kDigits = 16;

}  // namespace

std::string to_string(VoxelId id) {
  std::string text(kDigits, '0');
  auto bits = static_cast<std::uint64_t>(id);
  for (std::size_t i = kDigits; i-- > 0; bits >>= 4) text[i] = "0123456789abcdef"[bits & 15];
  return text;
}

std::optional<VoxelId> parse_voxel_id(std::string_view text) {
  std::uint64_t bits = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bits, 16);
  const bool whole = error == std::errc() && end == text.data() + text.size() && text.size() == kDigits;
  if (!whole || bits >> (3 * kIdBits) != 0) return std::nullopt;
  return VoxelId{bits};
}

}  // namespace vdbmap
