// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "vdbmap/io/laz/integer_decoder.h"

namespace vdbmap::laz {

// GPS times are doubles whose bits are taken for integers. Differences of these repeat: a pulse comes after a multiple
// of the interval that came before.

/// Multiples of the last difference that have a symbol of their own: up to 500, and down to -10 behind them.
inline constexpr unsigned kHighestMultiple = 500;
inline constexpr unsigned kLowestMultiple = kHighestMultiple + 10;

/// Reads times of up to four interleaved sequences, of LASzip's versions 2 and 3. `kHasUnchanged`: a symbol says that
/// the time is that of the point before (version 2); else that is known already (version 3).
template <bool kHasUnchanged>
class GpsTimeDecoder {
 public:
  explicit GpsTimeDecoder(std::uint64_t first) { sequences_[0].time = first; }

  std::uint64_t decode(ArithmeticDecoder& decoder) {
    // Damaged bytes may switch from sequence to sequence until they end.
    while (!decoder.is_beyond_end() && !decode_in_sequence(decoder)) continue;
    return current().time;
  }

 private:
  // Codes of both kinds of symbols in version 2; version 3 leaves out kUnchanged, and so has those behind it one lower.
  enum WithoutInterval : unsigned { kSame, kShort, kWhole };
  static constexpr unsigned kUnchanged = kLowestMultiple + 1;
  static constexpr unsigned kFull = kLowestMultiple + 2;
  static constexpr unsigned kLeftOut = kHasUnchanged ? 0 : 1;
  static constexpr unsigned kNumSequences = 4;

  enum Context : unsigned { kFirst, kOnce, kFew, kMany, kMost, kBack, kMostBack, kZero, kHighHalf, kNumContexts };

  struct Sequence {
    std::uint64_t time = 0;       // bits of a double
    std::uint32_t interval = 0;   // between two times
    unsigned num_exceptions = 0;  // in a row, of times that did not keep to it
  };

  Sequence& current() { return sequences_[last_]; }

  // False where only the sequence was switched.
  bool decode_in_sequence(ArithmeticDecoder& decoder) {
    return current().interval == 0 ? decode_without_interval(decoder) : decode_with_interval(decoder);
  }

  bool decode_without_interval(ArithmeticDecoder& decoder) {
    const unsigned code = decoder.decode(without_interval_) + kLeftOut;
    if (code == kSame) return true;
    if (code > kWhole) return switch_by(code - kWhole);
    if (code == kWhole) return start_sequence(decoder);
    current().interval = integers_.decode(decoder, 0, kFirst);
    current().num_exceptions = 0;
    advance(current().interval);
    return true;
  }

  bool decode_with_interval(ArithmeticDecoder& decoder) {
    unsigned code = decoder.decode(multiples_);
    if (!kHasUnchanged && code >= kUnchanged) ++code;
    if (code == kUnchanged) return true;
    if (code > kFull) return switch_by(code - kFull);
    if (code == kFull) return start_sequence(decoder);
    const std::uint32_t interval = current().interval;
    const auto difference = [&](std::uint32_t multiple, Context context) {
      return integers_.decode(decoder, multiple * interval, context);
    };
    if (code == 1) {
      advance(difference(1, kOnce));
      current().num_exceptions = 0;
    } else if (code == 0) {
      advance_by_exception(difference(0, kZero));
    } else if (code < kHighestMultiple) {
      advance(difference(code, code < 10 ? kFew : kMany));
    } else if (code == kHighestMultiple) {
      advance_by_exception(difference(code, kMost));
    } else if (code < kLowestMultiple) {
      advance(difference(kHighestMultiple - code, kBack));
    } else {
      advance_by_exception(difference(kHighestMultiple - code, kMostBack));
    }
    return true;
  }

  bool switch_by(unsigned step) {
    last_ = (last_ + step) % kNumSequences;
    return false;
  }

  bool start_sequence(ArithmeticDecoder& decoder) {
    const auto high_half = static_cast<std::uint32_t>(current().time >> 32);
    const std::uint64_t high = integers_.decode(decoder, high_half, kHighHalf);
    newest_ = (newest_ + 1) % kNumSequences;
    last_ = newest_;
    current() = {high << 32 | decoder.decode_bits(32)};
    return true;
  }

  void advance(std::uint32_t difference) {
    current().time += static_cast<std::uint64_t>(static_cast<std::int64_t>(static_cast<std::int32_t>(difference)));
  }

  // After four exceptions in a row the last one is the interval.
  void advance_by_exception(std::uint32_t difference) {
    advance(difference);
    if (++current().num_exceptions <= 3) return;
    current().interval = difference;
    current().num_exceptions = 0;
  }

  std::array<Sequence, kNumSequences> sequences_;
  unsigned last_ = 0;
  unsigned newest_ = 0;
  SymbolModel<6 - kLeftOut> without_interval_;
  SymbolModel<kFull + kNumSequences - kLeftOut> multiples_;
  IntegerDecoder<32> integers_{kNumContexts};
};

/// The same of version 1: one sequence, other contexts.
class GpsTimeDecoder1 {
 public:
  explicit GpsTimeDecoder1(std::uint64_t first) : time_(first) {}

  std::uint64_t decode(ArithmeticDecoder& decoder) {
    if (interval_ == 0) {
      decode_without_interval(decoder);
    } else {
      decode_with_interval(decoder);
    }
    return time_;
  }

 private:
  static constexpr unsigned kHighest = 509;  // multiple
  static constexpr unsigned kFull = 510;     // 511: unchanged

  void decode_without_interval(ArithmeticDecoder& decoder) {
    const unsigned code = decoder.decode(without_interval_);
    if (code == 1) {
      interval_ = integers_.decode(decoder, 0, 0);
      advance(interval_);
    } else if (code == 2) {
      time_ = decoder.decode_64_bits();
    }
  }

  void decode_with_interval(ArithmeticDecoder& decoder) {
    const unsigned code = decoder.decode(multiples_);
    if (code == kFull) time_ = decoder.decode_64_bits();
    if (code >= kFull) return;
    const std::uint32_t difference = decode_difference(decoder, code);
    advance(difference);
    const bool is_exception = code == 0 || code == kHighest;
    if (is_exception) ++num_exceptions_;
    if (code == 1 || (is_exception && num_exceptions_ > 3)) {
      interval_ = difference;
      num_exceptions_ = 0;
    }
  }

  std::uint32_t decode_difference(ArithmeticDecoder& decoder, unsigned multiple) {
    if (multiple == 1) return integers_.decode(decoder, interval_, 1);
    if (multiple == 0) return integers_.decode(decoder, static_cast<std::uint32_t>(signed_interval() / 4), 2);
    return integers_.decode(decoder, multiple * interval_, multiple < 10 ? 3 : multiple < 50 ? 4 : 5);
  }

  std::int32_t signed_interval() const { return static_cast<std::int32_t>(interval_); }

  void advance(std::uint32_t difference) {
    time_ += static_cast<std::uint64_t>(static_cast<std::int64_t>(static_cast<std::int32_t>(difference)));
  }

  std::uint64_t time_;
  std::uint32_t interval_ = 0;
  unsigned num_exceptions_ = 0;
  SymbolModel<3> without_interval_;
  SymbolModel<512> multiples_;
  IntegerDecoder<32> integers_{6};
};

}  // namespace vdbmap::laz
