// What a check of a sequence found out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quell/image/image.h"
#include "quell/sequence/conventions.h"

namespace quell {

/// From the least to the most alarming.
enum class Verdict {
  not_tested,  ///< what the test needs is not there, or the images cannot tell; the text says why
  ok,
  suspicious,  ///< possible, but seldom meant so
  wrong,       ///< the numbers contradict each other
};
/// "ok", "suspicious", "WRONG", "not tested"
std::string_view name(Verdict verdict);

/// How an input has to be read so that the test would pass.
struct Remedy {
  std::string input;     ///< "motion"
  Conventions settings;  ///< what has to be stated otherwise, and nothing else
  bool operator==(const Remedy&) const = default;
};

/// A number that a verdict rests on, for programs.
struct Figure {
  std::string name;  ///< "p99_px"
  double value = 0;
};

struct Finding {
  Verdict verdict = Verdict::not_tested;
  std::string subject;  ///< what was tested: "motion agrees with the matrices"
  std::string text;     ///< how it turned out, with the figures
  std::optional<Remedy> remedy = std::nullopt;
  std::vector<Figure> figures = {};  ///< the first tells frames apart: the larger, the worse
  /// For pictures: the error of each pixel (a scalar, negative where nothing was tested), and the one that counts as large.
  Image errors = {};
  double large_error = 0;
  std::string error_unit = "";
  std::int64_t frame = 0;      ///< set by check_frame()
  bool frame_matters = false;  ///< set by check_frame(): the text tells of that frame alone
};

/// The figure of that name; nothing when there is none.
std::optional<double> figure(const Finding& finding, std::string_view name);

/// One finding for each subject, in the order in which they first appear: the most alarming one, and among equals the one with
/// the largest first figure. What was not tested in some frames does not matter where it was in others.
std::vector<Finding> worst_of(const std::vector<Finding>& findings);

}  // namespace quell
