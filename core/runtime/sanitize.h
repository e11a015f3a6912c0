// NaN and infinity are taken out of images and values once, where they enter a graph, so that no pass ever meets them.
#pragma once

#include <cstdint>
#include <string>

#include "quell/image/item.h"
#include "quell/runtime/executor.h"

namespace quell {

/// Values of an input that were NaN or infinite, and were replaced.
struct ReplacedValues {
  std::string input;
  PortType type = QUELL_TYPE_COLOR;
  std::int64_t count = 0;
};
/// "color: 3 values were NaN or infinite and count as 0"
std::string describe(const ReplacedValues& replaced);

/// Replaces every value that is NaN or infinite: by 0, in depth by the distance of "no surface". What somebody else holds as well
/// is copied first. Returns how many values were replaced; cameras and ids are left alone.
std::int64_t sanitize(Item& item, Executor& executor, BufferPool& pool);

}  // namespace quell
