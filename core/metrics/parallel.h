// How metrics use several threads without knowing whose they are.
#pragma once

#include <functional>

namespace quell {

/// Calls body(i) once for every i in [0, count), in any order and on any threads, and returns when all are done. No metric
/// depends on how: sums are made for bands of rows, which are fixed, and added up in their order. A body may run out of memory:
/// what it throws has to reach the caller, once no other is running.
using Parallel = std::function<void(int count, const std::function<void(int i)>& body)>;

/// One after the other, on the caller's thread.
inline void run_serially(int count, const std::function<void(int i)>& body) {
  for (int i = 0; i < count; ++i) body(i);
}

}  // namespace quell
