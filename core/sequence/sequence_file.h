// sequence.json: which files carry which input, by which convention.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "quell/sequence/frame_range.h"
#include "quell/sequence/input_spec.h"

namespace quell {

struct SequenceFile {
  std::string name, doc;
  std::optional<FrameRange> frames;
  InputSpecs inputs;
};

/// Reads a sequence.json (its format is written in core/sequence/README.md). File patterns are taken from its folder. Throws one
/// Error(input) that tells every mistake with its place.
SequenceFile read_sequence_file(const std::filesystem::path& file);

}  // namespace quell
