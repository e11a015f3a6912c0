// Compares series of images with a reference, frame by frame.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image_series.h"
#include "quell/metrics/comparison.h"
#include "quell/runtime/executor.h"

namespace quell::app {

struct ComparisonJob {
  ImageSeries reference;
  std::vector<ImageSeries> images;
  std::vector<std::string> labels;    ///< of the images
  std::optional<ImageSeries> motion;  ///< for Metric::warped
  std::vector<std::int64_t> frames;   ///< ascending; every series but motion has them
  CompareOptions options;
  bool want_maps = false;
};

/// Of one image.
struct ImageFigures {
  std::vector<Score> scores;     ///< of each metric
  std::uint64_t bad_pixels = 0;  ///< NaN or infinite
};

struct ComparedFrame {
  std::int64_t frame = 0;
  std::string error;  ///< why it could not be compared; "" when it was
  bool has_previous = false;
  bool lacks_motion = false;  ///< Metric::warped could not be told for want of a file
  std::uint64_t bad_pixels_in_reference = 0;
  std::vector<ImageFigures> images;  ///< none when it could not be compared
  double seconds = 0;
};

/// The images of a frame, for who draws them.
struct FramePictures {
  std::int64_t frame = 0;
  Image reference;
  std::vector<Image> images;
  std::vector<Image> flip_maps, hdr_flip_maps;  ///< of the images; null ones when they were not asked for
};

struct ComparisonHooks {
  std::function<bool()> cancelled = [] { return false; };
  /// After each frame, in order. Pictures only of a frame that was compared.
  std::function<void(const ComparedFrame&, const FramePictures*)> on_frame = [](const auto&, const auto*) {};
};

/// Every image of a frame counts, or none: one that cannot be read, or has another size than its reference, is the frame's error.
/// Frames are read ahead, one at a time. When cancelled, ends after the frame in work, with what was compared until then. The
/// figures are the same for any executor, bit for bit.
std::vector<ComparedFrame> run_comparison(const ComparisonJob& job, Executor& executor, const ComparisonHooks& hooks);

/// The exposures that show all reference images of these frames; reads them. Frames that cannot be read are left out. Nothing
/// when cancelled. `progress` is told how many frames are done.
std::optional<Exposures> find_exposures(const ImageSeries& reference, const std::vector<std::int64_t>& frames, Executor& executor,
                                        const std::function<bool()>& cancelled, const std::function<void(std::size_t)>& progress);

/// The sum over all frames that were compared, of each image.
std::vector<ImageFigures> add_up(const std::vector<ComparedFrame>& frames, std::size_t images, std::size_t metrics);

/// For the metrics, on the executor's threads. An exception of a body is thrown when all have ended.
Parallel run_on(Executor& executor);

}  // namespace quell::app
