// A frame's inputs and the errors that checks found in them, as pictures.
#pragma once

#include <vector>

#include "quell/sequence/checks/finding.h"
#include "quell/sequence/checks/frame_data.h"
#include "quell/sequence/contact_sheet.h"

namespace quell {

/// One panel for each image of the frame: color by a simple tone curve, normals as colors, positions and depth from their nearest
/// to their farthest, ids in colors of their own, motion as hue (direction) and brightness (length); then one for each finding of
/// the frame that tells errors, dark where small, gray where nothing was tested. All are of one size.
std::vector<Panel> make_panels(const FrameData& frame, const std::vector<Finding>& findings);

}  // namespace quell
