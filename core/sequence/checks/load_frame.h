// A frame of a sequence, read for the checks.
#pragma once

#include "quell/sequence/checks/finding.h"
#include "quell/sequence/checks/frame_data.h"
#include "quell/sequence/sequence.h"

namespace quell {

/// Reads everything that the sequence has in a frame. Of several inputs of a type, the one that is named like it is checked as
/// such. What cannot be read is left out, and told in `problems`; so is an input whose type is not known.
FrameData load_frame(Sequence& sequence, std::int64_t frame, BufferPool& pool, std::vector<Finding>& problems);

/// The subject under which problems of an input are told: "depth can be read".
std::string reading_subject(std::string_view input);

}  // namespace quell
