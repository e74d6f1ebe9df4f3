// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vdbmap::test {

/// Whether this program runs under a sanitizer, some ten times slower: long tests then take a part of their input.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace vdbmap::test
