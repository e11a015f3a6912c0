// The motion that cameras and objects' matrices tell.
#pragma once

#include "quell/sequence/checks/geometry.h"

namespace quell {

/// Motion of each pixel (pixels, y down, previous minus current, without jitter): of its surface point, else of the point at
/// infinity that is seen there. NaN where it is not known. Needs both cameras, of the images' size, and points.
Image expected_motion(const FrameData& frame, const Surfaces& surfaces, Size size);

}  // namespace quell
