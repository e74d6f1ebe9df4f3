// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/task_arena.h>

#include "vdbmap/core/parallel.h"

namespace vdbmap::test {

/// What `body` returns when `count` threads work for it, more than the machine has cores if need be.
template <typename Body>
auto on_threads(int count, const Body& body) {
  const ThreadLimit limit(static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  return arena.execute(body);
}

}  // namespace vdbmap::test
