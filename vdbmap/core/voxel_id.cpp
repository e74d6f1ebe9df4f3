// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/voxel_id.h"

#include <charconv>

namespace vdbmap {
namespace {

constexpr int kBits = 21;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr std::size_t kDigits = 16;

std::uint64_t biased(std::int32_t index) { return static_cast<std::uint64_t>(index + kIndexLimit) & kMask; }

std::int32_t unbiased(std::uint64_t bits) { return static_cast<std::int32_t>(bits & kMask) - kIndexLimit; }

}  // namespace

VoxelId id_of_voxel(const VoxelIndex& voxel) {
  return VoxelId{biased(voxel.x()) << (2 * kBits) | biased(voxel.y()) << kBits | biased(voxel.z())};
}

VoxelIndex voxel_of_id(VoxelId id) {
  const auto bits = static_cast<std::uint64_t>(id);
  return {unbiased(bits >> (2 * kBits)), unbiased(bits >> kBits), unbiased(bits)};
}

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
  if (!whole || bits >> (3 * kBits) != 0) return std::nullopt;
  return VoxelId{bits};
}

}  // namespace vdbmap
