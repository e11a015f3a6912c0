// What a run does about frames of which files are missing.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "quell/image/stream.h"
#include "quell/sequence/sequence.h"

namespace CLI {
class App;
}

namespace quell::app {

enum class OnMissing {
  usual,  ///< an error where such frames were asked for by --frames, else they are left out with a warning
  error,
  hold,   ///< the latest earlier file of the input stands in
  reset,  ///< they are left out, and history ends there, as at a cut
  fail,   ///< they count as frames that failed
};

/// The frames of a run, and how they are computed.
struct ChosenFrames {
  std::vector<std::int64_t> frames;                                    ///< ascending
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> holds;  ///< of a missing file: the frame that stands in
  std::vector<std::int64_t> cuts;                                      ///< frames before which history ends
};

/// Of these inputs. Warns of what is left out or stands in. Throws Error(input) naming `place` for frames that cannot be
/// computed, and when none is left.
ChosenFrames choose_frames(const Sequence& sequence, const std::vector<std::string>& inputs, OnMissing on_missing,
                           const std::string& place);

/// A sequence in which other frames stand in for those that are missing.
class HoldingSource final : public FrameSource {
 public:
  HoldingSource(std::shared_ptr<Sequence> sequence, std::map<std::pair<std::string, std::int64_t>, std::int64_t> holds)
      : sequence_(std::move(sequence)), holds_(std::move(holds)) {}
  std::optional<Shape> shape(std::string_view input) override { return sequence_->shape(input); }
  Item read(std::string_view input, std::int64_t frame, BufferPool& pool) override;
  bool uses_processor() const override { return sequence_->uses_processor(); }

 private:
  std::shared_ptr<Sequence> sequence_;
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> holds_;
};

}  // namespace quell::app
