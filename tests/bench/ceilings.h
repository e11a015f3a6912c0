// What the machine can do at best, measured by loops that do nothing else: the ceilings that kernels are compared with.
#pragma once

#include <functional>

#include "tests/bench/mix.h"

namespace quell::bench {

/// Seconds from when `count` threads begin body(0), body(1), ... together until the last is done.
double time_threads(int count, const std::function<void(int)>& body);

/// Bytes read and written a second by a copy between images far larger than the last-level cache.
double measure_copy_bandwidth(int threads);

/// Floating-point operations a second of independent multiply-adds, on the current vector unit.
double measure_peak_flops(int threads);

enum class Kernel { joint_bilateral, atrous };
/// Of a unit of its work: of the joint bilateral filter a tap, of the à-trous filter, whose taps share some, a pixel.
const Mix& mix_of(Kernel kernel);

/// The issue bound: seconds for a unit of work when the operations of the kernel's mix are all independent of each other
/// and all loads hit the first-level cache. Divided by the number of threads, measured while all of them run.
double measure_issue_bound(Kernel kernel, int threads);

/// The above, best of several, measured once for each unit and number of threads.
struct Ceilings {
  double bytes_per_second = 0, flops = 0;
};
const Ceilings& ceilings(int threads);
double issue_bound(Kernel kernel, int threads);

/// Pixels in a vector of the current unit.
int vector_lanes();

}  // namespace quell::bench
