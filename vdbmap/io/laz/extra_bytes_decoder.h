// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "vdbmap/io/laz/arithmetic_decoder.h"

namespace vdbmap::laz {

/// Bytes that LAS knows nothing of: each by its difference from the point before; both versions.
class ExtraBytesDecoder {
 public:
  explicit ExtraBytesDecoder(std::string_view first) : last_(first.begin(), first.end()), models_(first.size()) {}

  void decode(ArithmeticDecoder& decoder, char* bytes) {
    for (std::size_t i = 0; i < last_.size(); ++i) {
      last_[i] = static_cast<char>(static_cast<unsigned char>(last_[i]) + decoder.decode(models_[i]));
      bytes[i] = last_[i];
    }
  }

 private:
  std::vector<char> last_;
  std::vector<SymbolModel<256>> models_;
};

}  // namespace vdbmap::laz
