// quell run --skip-existing: which frames are there already.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chunk.h"
#include "results.h"

namespace quell::app {

/// What a frame's results depend on beside the graph, for the header of its files ("quell:inputs"): names of files without their
/// folders, the part of the images that is read, cuts, and, where history counts, the frame that it begins with.
std::string describe_inputs(const Job& job, const SequenceArguments& sequence, const SessionOptions& options,
                            const Surroundings& around);

/// Takes frames out of the job's that need not be written again: each of their files is there, newer than all files that it was
/// made of, can be read to its last pixel, and says in its header that it is of this graph, these inputs and this frame. Those
/// that a later frame's history needs are computed for it. Tells how many. May leave no frame.
void skip_existing(Job& job, Surroundings& around, const std::vector<ResultFiles>& results, const FileSinkOptions& output);

}  // namespace quell::app
