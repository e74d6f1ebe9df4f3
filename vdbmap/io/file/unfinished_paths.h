// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <string>

namespace vdbmap {

/// Paths that a signal handler may remove: plain memory, claimed and released with atomics only. Of more than
/// `Capacity` at once, the later ones are not remembered.
template <std::size_t Capacity>
class UnfinishedPaths {
 public:
  void remember(const std::string& path) {
    for (Place& place : places_) {
      int expected = kFree;
      if (path.size() >= place.path.size() || !place.state.compare_exchange_strong(expected, kBeingFilled)) continue;
      std::memcpy(place.path.data(), path.c_str(), path.size() + 1);
      place.state.store(kFilled);
      return;
    }
  }

  void forget(const std::string& path) {
    for (Place& place : places_) {
      if (place.state.load() == kFilled && path == place.path.data()) place.state.store(kFree);
    }
  }

  /// Calls body(path) with a const char* for each; safe in a signal handler where the body is.
  template <typename Body>
  void for_each(const Body& body) const noexcept {
    for (const Place& place : places_) {
      if (place.state.load() == kFilled) body(place.path.data());
    }
  }

 private:
  static constexpr int kFree = 0;
  static constexpr int kBeingFilled = 1;
  static constexpr int kFilled = 2;

  struct Place {
    std::atomic<int> state{kFree};
    std::array<char, 4096> path{};
  };
  std::array<Place, Capacity> places_;
};

}  // namespace vdbmap
