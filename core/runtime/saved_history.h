// What a session has to know of the frames before it, to go on where another one has ended.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/image/item.h"

namespace quell {

/// All that the frames after `frame` can reach of those until then. With it, a session of the same graph, passes, vector unit and
/// cuts yields the same bits as one that has computed these frames itself.
struct SavedHistory {
  struct Kept {
    std::string from;  ///< Graph::describe() of what yielded it
    std::int64_t frame = 0;
    Item item;
  };
  std::int64_t frame = 0;  ///< up to here all frames are through, failed ones among them
  InputShapes shapes;      ///< of the inputs that were planned for last
  std::vector<Kept> items;
  std::vector<std::vector<std::int64_t>> resets;  ///< for each reset of the graph: the frames that it was given in
};

}  // namespace quell
