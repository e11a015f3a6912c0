// The metrics as their papers write them, in double, without separable windows, vectors or bands: what compare() must equal.
#pragma once

#include "quell/metrics/comparison.h"

namespace quell::test {

/// Scores of one metric by its definition.
Score naive_score(const CompareInput& input, Metric metric, DisplayTransform display);

}  // namespace quell::test
