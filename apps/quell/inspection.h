// What `quell inspect` finds out about a sequence.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "quell/sequence/checks/finding.h"
#include "quell/sequence/checks/frame_data.h"
#include "quell/sequence/sequence.h"

namespace quell::app {

/// A finding, and the option that would mend it.
struct Told {
  Finding finding;
  std::string option;  ///< "--in motion=...:sign=current-previous"; "" when there is none
};

struct Inspection {
  std::vector<std::int64_t> frames;  ///< that were tested
  std::vector<Told> told;            ///< the worst of each subject
  FrameData picture;                 ///< the frame to be drawn, the one in which most could be tested
  std::vector<Finding> picture_findings;

  std::size_t count(Verdict verdict) const;
};

/// Every frame for which all inputs have files; when there is none, every frame for which any has.
std::vector<std::int64_t> all_frames(const Sequence& sequence);
/// The first three, and the middle one.
std::vector<std::int64_t> choose_frames(const std::vector<std::int64_t>& all);

/// Reads and tests these frames. `progress` is told how many are done.
Inspection inspect(Sequence& sequence, const std::vector<std::int64_t>& frames, const std::function<void(std::size_t)>& progress);

}  // namespace quell::app
