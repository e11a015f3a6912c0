// The order of nodes, and cycles. Private to this box.
#pragma once

#include <vector>

namespace quell::detail {

/// For each node, the nodes whose results of the same frame it needs. An index may stand more than once.
using Dependencies = std::vector<std::vector<int>>;

/// Every node after those that it needs; of those that could come next, the one with the smallest index. Nodes in or behind a
/// cycle are missing.
std::vector<int> sort_topologically(const Dependencies& needs);

/// For every group of nodes that reach each other, one of its shortest cycles: each node needs the next one, and the last needs
/// the first, which has the smallest index.
std::vector<std::vector<int>> find_cycles(const Dependencies& needs);

}  // namespace quell::detail
