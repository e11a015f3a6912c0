// Compares an image with its reference, frame by frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "quell/image/image.h"
#include "quell/metrics/display.h"
#include "quell/metrics/flip.h"
#include "quell/metrics/metric.h"
#include "quell/metrics/parallel.h"

namespace quell {

struct CompareOptions {
  std::vector<Metric> metrics;
  DisplayTransform display = DisplayTransform::reinhard;
  double pixels_per_degree = kPixelsPerDegree;
  /// For Metric::hdr_flip; nothing: chosen for each reference alone, which makes figures of frames incomparable.
  std::optional<Exposures> exposures = {};
};

/// Color images of one size, as they were read: they may hold NaN and infinity.
struct ImagePair {
  Image reference, image;
};

struct CompareInput {
  ImagePair pair;
  /// The frame before this one, for temporal metrics; none: they cannot be told.
  std::optional<ImagePair> previous = {};
  /// Motion of the reference, pixels, y down, previous position minus current, for Metric::warped; none: nothing moves.
  Image motion = {};
};

struct FrameScores {
  std::vector<Score> scores;  ///< one for each of the options' metrics, in their order
  /// Pixels with a channel that is NaN or infinite. A pixel that is so in either image counts in no metric, and is 0 in both
  /// for metrics that look at neighborhoods. Temporal metrics leave out those of both frames.
  std::uint64_t bad_in_reference = 0, bad_in_image = 0;
  /// Errors of each pixel (scalar), when asked for.
  Image flip_map, hdr_flip_map;
};

/// Scores of one frame. The same for any `parallel`, bit for bit. `want_maps` asks for the maps of those of flip and hdr_flip
/// that are among the metrics. Throws Error(input) when sizes or types do not fit, naming both, and what flip() and hdr_flip()
/// throw for options that are none.
FrameScores compare(const CompareInput& input, const CompareOptions& options, bool want_maps, BufferPool& pool,
                    const Parallel& parallel = run_serially);

}  // namespace quell
