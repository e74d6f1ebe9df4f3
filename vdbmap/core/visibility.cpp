// SPDX-License-Identifier: GPL-3.0-or-later
#include "vdbmap/core/visibility.h"

namespace vdbmap {

std::size_t memory_bytes(const Visibility& visibility) {
  return visibility.seen_empty.memory_bytes() +
         (visibility.hits.capacity() + visibility.passes.capacity()) * sizeof(std::uint32_t);
}

}  // namespace vdbmap
