// One frame after the other, one node after the other: the reference for every other way of running.
#pragma once

#include <cstdint>
#include <vector>

#include "quell/runtime/input_reader.h"
#include "quell/runtime/session_state.h"

namespace quell {

/// As Session::run, for frames that ascend, when a first plan has been made.
std::vector<FrameReport> run_serially(SessionState& session, const RunFrames& frames, FrameSource& source, FrameSink& sink);

}  // namespace quell
