// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include "vdbmap/core/parallel.h"

namespace vdbmap {

/// As parallel_for(), for bodies that may throw and have parallel loops of their own. Where a body of parallel_for()
/// throws, oneTBB cancels the loops within the others too: they return half done, and what follows them finds data that
/// is not there. Here all bodies come to their end, and of several errors that of the lowest number is thrown.
template <typename Body>
void parallel_tasks(std::size_t count, const Body& body) {
  std::vector<std::exception_ptr> errors(count);
  parallel_for(count, [&](std::size_t i) {
    try {
      body(i);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace vdbmap
