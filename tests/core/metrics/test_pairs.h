// Images to compare, and comparing them in a line.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quell/metrics/comparison.h"
#include "quell/testing/pass_test.h"

namespace quell::test {

/// Repeatable noise in [0, 1).
double noise(int x, int y, int c, unsigned seed);

/// Radiance with dark and bright parts, a few negative values, and an image of it that is noisy.
ImagePair make_pair(Size size, unsigned seed = 1, int spare_lines = 0);
/// An image of one color.
Image flat(Size size, float red, float green, float blue);
inline Image gray(Size size, float value) { return flat(size, value, value, value); }

/// The scores of `metrics`, in their order.
std::vector<Score> scores(const CompareInput& input, const std::vector<Metric>& metrics,
                          DisplayTransform display = DisplayTransform::none, const Parallel& parallel = run_serially);
Score score(const CompareInput& input, Metric metric, DisplayTransform display = DisplayTransform::none);
/// Its figure.
double figure(const CompareInput& input, Metric metric, DisplayTransform display = DisplayTransform::none);

/// All but those of FLIP, which have tests of their own.
const std::vector<Metric>& plain_metrics();

/// The vector units of this machine that the metrics were compiled for, best first.
std::vector<std::int64_t> vector_units();
/// Has metrics use one of them.
void use_vector_unit(std::int64_t unit);
void use_best_vector_unit();
std::string name_of_vector_unit(std::int64_t unit);

}  // namespace quell::test
