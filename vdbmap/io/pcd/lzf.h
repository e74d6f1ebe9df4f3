// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vdbmap {

// LZF (Lehmann, LibLZF), the compression of PCD files. A byte below 32 announces one more literal bytes than its value;
// any other a copy of earlier output: 3 bits of length, 13 bits of distance, one more byte of length where the 3 are
// all set.

/// No LZF data expand to more than this many times their length: a copy of 264 bytes takes 3.
inline constexpr std::uint64_t kMostLzfExpansion = 88;

/// Nothing where `compressed` is not LZF data of exactly `size` bytes. Takes memory only for what `compressed` can
/// expand to: at most 88 times its length.
std::optional<std::string> lzf_decompress(std::string_view compressed, std::uint64_t size);

/// Never more than 1/32 and one byte longer than `data`.
std::string lzf_compress(std::string_view data);

}  // namespace vdbmap
