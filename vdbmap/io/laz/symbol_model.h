// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>

namespace vdbmap::laz {

/// Adaptive probabilities are fractions of 2^15, those of a single bit of 2^13.
inline constexpr unsigned kShareBits = 15;
inline constexpr unsigned kBitShareBits = 13;

/// Symbols of some number are looked up by the first bits of their share: about four symbols a bucket.
constexpr unsigned bucket_bits(unsigned num_symbols) {
  return std::max(5U, static_cast<unsigned>(std::bit_width(num_symbols - 1))) - 2;
}

/// How often each of up to `kCapacity` symbols came, as an arithmetic coder needs it: [0, 2^15) cut into one range a
/// symbol. The ranges are computed anew after more and more symbols (Said, "Introduction to Arithmetic Coding", HP Labs
/// HPL-2004-76, the adaptive model with periodic updates). Encoder and decoder share it.
template <unsigned kCapacity>
class SymbolModel {
 public:
  explicit SymbolModel(unsigned num_symbols = kCapacity)
      : num_symbols_(num_symbols), shift_(kShareBits - bucket_bits(num_symbols)), cycle_(num_symbols) {
    std::fill_n(counts_.begin(), num_symbols, std::uint16_t{1});
    starts_.fill(kBeyond);
    update();
    cycle_ = until_update_ = (num_symbols + 6) / 2;
  }

  unsigned last() const { return num_symbols_ - 1; }

  /// Where the range of a symbol begins.
  std::uint32_t start(unsigned symbol) const { return starts_[symbol]; }

  /// The symbol whose range holds `share`; what lies beyond all ranges belongs to the last symbol.
  unsigned find(std::uint32_t share) const {
    unsigned symbol = kIsSmall ? 0 : buckets_[share >> shift_];
    while (starts_[symbol + 1] <= share) ++symbol;
    return symbol;
  }

  void count(unsigned symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }

 private:
  static_assert(kShareBits - bucket_bits(kCapacity) > 6);
  static constexpr bool kIsSmall = kCapacity <= 16;  // fewer symbols than are worth buckets
  static constexpr std::uint16_t kBeyond = 0xffff;   // above every share, the largest of which is 2^15 + 64
  static constexpr std::uint32_t kMostCounts = 1 << kShareBits;

  void halve_counts() {
    num_counted_ = 0;
    for (unsigned i = 0; i < num_symbols_; ++i) {
      counts_[i] = static_cast<std::uint16_t>((counts_[i] + 1) / 2);
      num_counted_ += counts_[i];
    }
  }

  void update() {
    num_counted_ += cycle_;
    if (num_counted_ > kMostCounts) halve_counts();

    const std::uint32_t scale = 0x80000000U / num_counted_;
    std::uint32_t sum = 0;
    for (unsigned i = 0; i < num_symbols_; ++i) {
      starts_[i] = static_cast<std::uint16_t>(scale * sum >> 16);
      sum += counts_[i];
    }
    if constexpr (!kIsSmall) fill_buckets();
    cycle_ = std::min(5 * cycle_ / 4, (num_symbols_ + 6) * 8);
    until_update_ = cycle_;
  }

  // For each bucket of shares the symbol at its begin. Buckets are no narrower than the 64 that shares exceed 2^15 by,
  // so that one more is enough.
  void fill_buckets() {
    unsigned bucket = 0;
    for (unsigned i = 1; i < num_symbols_; ++i) {
      const unsigned end = (starts_[i] + (1U << shift_) - 1) >> shift_;
      for (; bucket < end; ++bucket) buckets_[bucket] = static_cast<std::uint16_t>(i - 1);
    }
    for (; bucket <= 1U << (kShareBits - shift_); ++bucket) buckets_[bucket] = static_cast<std::uint16_t>(last());
  }

  std::uint32_t num_symbols_;
  std::uint32_t shift_;
  std::uint32_t cycle_;
  std::uint32_t until_update_ = 0;
  std::uint32_t num_counted_ = 0;
  std::array<std::uint16_t, kCapacity + 1> starts_;
  std::array<std::uint16_t, kCapacity> counts_;
  std::array<std::uint16_t, kIsSmall ? 1 : (1U << bucket_bits(kCapacity)) + 1> buckets_;
};

/// Models of one kind, of which few are used: each is made when it is asked for first.
template <unsigned kCount, unsigned kCapacity>
class ModelSet {
 public:
  SymbolModel<kCapacity>& at(unsigned index, unsigned num_symbols = kCapacity) {
    if (!models_[index]) models_[index] = std::make_unique<SymbolModel<kCapacity>>(num_symbols);
    return *models_[index];
  }

 private:
  std::array<std::unique_ptr<SymbolModel<kCapacity>>, kCount> models_;
};

/// The same for a single bit.
class BitModel {
 public:
  /// Share of the zeros.
  std::uint32_t zeros() const { return zeros_; }

  void count(bool bit) {
    if (!bit) ++num_zeros_;
    if (--until_update_ == 0) update();
  }

 private:
  void update() {
    num_counted_ += cycle_;
    if (num_counted_ > 1U << kBitShareBits) {
      num_counted_ = (num_counted_ + 1) / 2;
      num_zeros_ = (num_zeros_ + 1) / 2;
      if (num_zeros_ == num_counted_) ++num_counted_;
    }
    zeros_ = num_zeros_ * (0x80000000U / num_counted_) >> (31 - kBitShareBits);
    cycle_ = std::min(5 * cycle_ / 4, 64U);
    until_update_ = cycle_;
  }

  std::uint32_t num_zeros_ = 1;
  std::uint32_t num_counted_ = 2;
  std::uint32_t zeros_ = 1 << (kBitShareBits - 1);
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

}  // namespace vdbmap::laz
