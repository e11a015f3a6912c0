// Small images of known difference for the tests of `quell compare`.
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "quell/text/json.h"
#include "tests/apps/sample.h"

namespace quell::app::testing {

class CompareTest : public RunnerTest {
 protected:
  static constexpr int kWidth = 16, kHeight = 12;

  /// NAME (below the test's folder), all of one value.
  void make_flat(const std::string& name, double value, int width = kWidth, int height = kHeight) const;
  /// By pixel; the same in all channels.
  void make_image(const std::string& name, const std::vector<double>& values, int width = kWidth, int height = kHeight) const;
  /// Two pixels to the left (previous minus current), everywhere.
  void make_motion(const std::string& name) const;
  /// An 8-bit picture of this radiance.
  void make_png(const std::string& name, double radiance) const;

  /// quell compare ARGUMENTS in the test's folder: operands without a slash in front are names below it.
  Outcome compare(const std::vector<std::string>& operands, std::vector<std::string> options = {}) const;
  /// The object that `compare ... --json -` prints.
  Json compare_json(const std::vector<std::string>& operands, std::vector<std::string> options = {}) const;
  Json parse(const std::string& text) const;

  /// The figure over all frames, or of a frame of that place; a member of it: value, sum, count.
  static const Json& figure(const Json& comparison, const std::string& metric, std::size_t image = 0, int frame = -1,
                            const char* member = "value");
};

}  // namespace quell::app::testing
