// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

namespace vdbmap {

/// Calls body(i) for every i of [0, count), on all threads allowed. Bodies must not depend on each other; so the
/// result is the same for any number of threads. `grain` indices at least are run one after the other.
template <typename Body>
void parallel_for(std::size_t count, const Body& body, std::size_t grain = 1) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
  });
}

/// Calls body(begin, end) for ranges that together cover [0, count); for bodies that keep state over a range.
template <typename Body>
void parallel_ranges(std::size_t count, std::size_t grain, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const auto& range) { body(range.begin(), range.end()); });
}

/// Working memory that bodies running at the same time do not share. A body must not depend on what is left in it.
template <typename Value>
class PerThread {
 public:
  Value& mine() { return values_.local(); }

 private:
  tbb::enumerable_thread_specific<Value> values_;
};

/// Sorts by an order in which no two values are equal; so the result is the same for any number of threads.
template <typename Value, typename Less>
void parallel_sort(std::vector<Value>& values, const Less& less) {
  tbb::parallel_sort(values.begin(), values.end(), less);
}

/// Returns body(), which may work on all threads; this one takes up no other work while it waits for them. For bodies
/// that hold a lock: other work might wait for it.
template <typename Body>
auto isolated(const Body& body) {
  return tbb::this_task_arena::isolate(body);
}

/// How many threads may work in this process.
inline std::size_t num_threads() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

/// While it lives, at most `max_threads` threads work in this process (0: all cores).
class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t max_threads)
      : control_(tbb::global_control::max_allowed_parallelism,
                 max_threads > 0 ? max_threads
                                 : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)) {}

 private:
  tbb::global_control control_;
};

}  // namespace vdbmap
