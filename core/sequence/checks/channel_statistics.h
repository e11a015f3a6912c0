// What the channels of a file hold.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "quell/sequence/image_file.h"

namespace quell {

/// Of the finite numbers of one channel.
struct ChannelStatistics {
  double min = 0, max = 0, mean = 0;
  std::uint64_t finite = 0, nan = 0, infinite = 0;
};

/// Reads every channel, a band of rows at a time, over its own data window. `progress` is told the share that is done (0 to 1)
/// now and then. Throws Error(input) for a damaged file.
std::vector<ChannelStatistics> measure_channels(ImageFile& file, const std::function<void(double)>& progress);

}  // namespace quell
