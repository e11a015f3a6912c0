// What went wrong in a frame, in words for its report.
#pragma once

#include <cstdint>
#include <new>
#include <string>

#include "quell/image/buffer_pool.h"

namespace quell {

/// What became of a node in a frame.
enum class Outcome : std::uint8_t {
  pending,
  done,
  failed,
  lost,  ///< a node that it needs failed, or was lost
};

inline std::string out_of_memory(const BufferPool& pool) {
  return "out of memory, with " + std::to_string(pool.usage().in_use >> 20) + " MiB of images held";
}

/// What the exception at hand says. Only within a catch block.
inline std::string what_failed(const BufferPool& pool) {
  try {
    throw;
  } catch (const std::bad_alloc&) { return out_of_memory(pool); } catch (const std::exception& error) {
    return error.what();
  } catch (...) { return "an exception that tells nothing"; }
}

}  // namespace quell
