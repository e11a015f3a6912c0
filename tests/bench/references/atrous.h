// A level of the à-trous wavelet with the stops of SVGF as one writes it from the paper, without vectors.
#pragma once

#include <vector>

#include "tests/bench/references/float3.h"

namespace quell::bench {

/// Rows one after the other, without gaps.
struct AtrousFrame {
  int width = 0, height = 0;
  std::vector<Float3> color, normal;
  std::vector<float> depth, variance;
};

struct AtrousSettings {
  int level = 0;
  float sigma_z = 1, eps_z = 1e-6F, sigma_n = 128, sigma_l = 4;
};

struct AtrousResult {
  std::vector<Float3> color;
  std::vector<float> variance;
};

/// Schied et al. 2017, equations 3 to 5, with the gradient of depth as the pass `atrous` describes it; OpenMP over rows.
AtrousResult filter_as_the_paper(const AtrousFrame& frame, const AtrousSettings& settings, int threads);

}  // namespace quell::bench
