// Made-up frames: inputs of every port type that look like a small rendered scene, different for every seed.
#pragma once

#include <cstdint>

#include "quell/image/item.h"

namespace quell {

/// An item of that type. Images show two walls and a floor that moves a little, with a strip of background on the right when the
/// image is wide enough; colors are noisy. The same arguments always give the same bits.
Item synthetic(PortType type, Size size, std::uint32_t seed = 0, int spare_lines = 0);

/// The same item with one pixel (all planes) changed to something else of that type. The rest keeps its bits.
Item with_other_pixel(const Item& item, int x, int y, int spare_lines = 0);
/// The same image with NaN and infinity in one pixel.
Item with_bad_pixel(const Item& item, int x, int y);

}  // namespace quell
