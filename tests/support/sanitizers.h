// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// GCC defines macros, Clang has a feature.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VDBMAP_IS_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define VDBMAP_IS_SANITIZED
#endif
#endif

namespace vdbmap::test {

/// Whether this program runs under a sanitizer, some ten times slower: long tests then take a part of their input.
#ifdef VDBMAP_IS_SANITIZED
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace vdbmap::test
