// The main function of programs whose benchmarks run on vector units.
#pragma once

#include <functional>

namespace quell::bench {

/// As Google Benchmark's own, but on the unit that QUELL_ISA names, and with it in the report. `add` registers further
/// benchmarks.
int run_benchmarks(int argc, char** argv, const std::function<void()>& add = {});

}  // namespace quell::bench
