// What the benchmarks let the filters do, and how much work that is.
#pragma once

#include "tests/bench/ceilings.h"
#include "tests/bench/frame.h"
#include "tests/bench/pass_runner.h"
#include "tests/bench/references/atrous.h"
#include "tests/bench/references/bilateral.h"

namespace quell::bench {

struct Work {
  double pixels = 0;
  double taps = 0;   ///< that lie in the image
  double units = 0;  ///< as ceilings.h counts them
  double bytes = 0;  ///< each input read once and each output written once
};

/// The filter with all four terms, distances in pixels, and the default sigmas.
PassSetup joint_bilateral_setup(const BenchFrame& frame, int radius);
Work joint_bilateral_work(Size size, int radius);
InterleavedFrame interleave(const BenchFrame& frame);

/// One level with the stops of SVGF, the default sigmas, and the variance carried along.
PassSetup atrous_setup(const BenchFrame& frame, int level);
Work atrous_work(Size size, int level);
AtrousFrame interleave_for_atrous(const BenchFrame& frame);

/// Seconds of a call.
double time_call(const std::function<void()>& call);

}  // namespace quell::bench
