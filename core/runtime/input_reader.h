// Reads a frame's inputs from a source: what the plan uses, cleaned of NaN and infinity, with what looks ahead kept for later.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/image/stream.h"
#include "quell/runtime/executor.h"
#include "quell/runtime/sanitize.h"

namespace quell {

class InputReader {
 public:
  InputReader(FrameSource& source, const std::vector<std::int64_t>& frames, Executor& executor, BufferPool& pool)
      : source_(source), frames_(frames.begin(), frames.end()), executor_(executor), pool_(pool) {}

  /// One item for each graph input; nothing for those that the plan does not use. What was replaced is added to `replaced`.
  /// Throws what the source throws.
  std::vector<Item> read(std::int64_t frame, const Plan& plan, std::vector<ReplacedValues>& replaced);
  /// A frame that lies ahead; nothing when it is not part of the run or cannot be read, which its own turn will report.
  Item read_ahead(std::size_t input, std::int64_t frame, const Plan& plan);
  /// Lets go of what was read ahead up to this frame.
  void advance(std::int64_t frame);

 private:
  struct Read {
    Item item;
    std::int64_t replaced = 0;  ///< values that were NaN or infinite
  };
  Read read_one(const std::string& name, std::int64_t frame);

  FrameSource& source_;
  std::set<std::int64_t> frames_;
  Executor& executor_;
  BufferPool& pool_;
  std::map<std::pair<std::size_t, std::int64_t>, Read> ahead_;  // by input and frame
};

}  // namespace quell
