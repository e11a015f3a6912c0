// Which folder may include what, and a check of one source text against it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quell::test {

/// The includes of a text that break the layering, as `file:line: message`. `file` is the path from the repository's root, such
/// as "core/graph/plan.cpp"; it decides which rules hold.
std::vector<std::string> find_bad_includes(const std::string& file, std::string_view text);

}  // namespace quell::test
