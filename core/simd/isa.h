// Which of the machine's vector units kernels run on. The choice is one word in Highway's shared library: it holds for every
// plugin and for the metrics, for the whole process.
//
// Results on one vector unit are the same, bit for bit, for any threads and chunks; on different ones they differ in the last
// bits, since not all have a fused multiply-add.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quell {

/// Vector units of this machine that kernels are compiled for, best first: of "avx512", "avx2", "sse4", "ssse3", "neon",
/// "scalar".
const std::vector<std::string>& isas();

/// The one that kernels run on now.
std::string current_isa();

/// Lets kernels run on this one of isas(), or on the best again ("best"). A plugin that was not compiled for it takes the best
/// below. Call it while nothing is computed. Throws Error(usage) with `where`, which names an option, and the list.
void pin_isa(std::string_view name, std::string_view where);

/// Does that with the environment variable QUELL_ISA, where it is set and not empty, unless something was pinned before. Sessions
/// do not read the variable: `quell` does before it computes, and PassTest; a program that embeds quell calls this if it wants
/// to.
void pin_isa_from_environment();

}  // namespace quell
