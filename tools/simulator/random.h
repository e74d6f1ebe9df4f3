// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

namespace vdbmap::simulator {

/// A number that no other combination of numbers is likely to share (splitmix64, Steele, Lea & Flood 2014).
inline std::uint64_t hash(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9;
  value = (value ^ (value >> 27)) * 0x94d049bb133111eb;
  return value ^ (value >> 31);
}

inline std::uint64_t hash(std::uint64_t a, std::uint64_t b) { return hash(hash(a) ^ b); }

/// 53 random bits as a number of [0, 1).
inline double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

/// Random numbers of a generator of 64-bit numbers; the standard library's own distributions differ between libraries.
template <typename Engine>
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * unit_interval(engine_()); }

  /// True with the probability given.
  bool chance(double probability) { return uniform(0, 1) < probability; }

  /// Uniform in {0, ..., count - 1}.
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(uniform(0, static_cast<double>(count))); }

  /// Normal, by Box & Muller.
  double normal(double mean, double deviation) {
    const double radius = std::sqrt(-2 * std::log(1 - unit_interval(engine_())));
    return mean + deviation * radius * std::cos(2 * std::numbers::pi * unit_interval(engine_()));
  }

  /// A new seed, for a part of the work that must not depend on how many numbers the others draw.
  std::uint64_t seed() { return engine_(); }

 private:
  Engine engine_;
};

/// Counts on from a seed and hashes: costs nothing to set up, so that every ray has one of its own.
class CountingEngine {
 public:
  explicit CountingEngine(std::uint64_t seed) : next_(seed) {}
  std::uint64_t operator()() { return hash(next_++); }

 private:
  std::uint64_t next_;
};

using Random = RandomNumbers<std::mt19937_64>;
using RayRandom = RandomNumbers<CountingEngine>;

}  // namespace vdbmap::simulator
