// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace vdbmap {

/// Memory that the system is asked to back with huge pages (2 MB on x86), aligned to them. Throws std::bad_alloc.
///
/// The first touch of a page costs a fault of 0.5 to 7 us, more than it takes to fill 4 kB: arrays of tens of megabytes
/// that are written once are much faster with few large pages (map_benchmark: a map in a third to a half of the time).
void* allocate_huge(std::size_t bytes);
void free_huge(void* memory) noexcept;

/// Takes large arrays from allocate_huge() and small ones from the heap. Elements of trivial types begin without a
/// value where none is given.
template <typename T>
class LargeAllocator {
 public:
  using value_type = T;

  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>& /*other*/) noexcept {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(is_large(count) ? allocate_huge(bytes) : ::operator new(bytes));
  }

  void deallocate(T* memory, std::size_t count) noexcept {
    if (is_large(count)) {
      free_huge(memory);
    } else {
      ::operator delete(memory);
    }
  }

  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  bool operator==(const LargeAllocator& /*other*/) const { return true; }

 private:
  static constexpr std::size_t kLeastBytes = std::size_t{4} << 20;
  static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);

  static constexpr bool is_large(std::size_t count) { return count >= kLeastBytes / sizeof(T); }
};

/// A vector for millions of elements.
template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace vdbmap
