// Measures results against a reference while they are written: `quell run --reference`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "image_series.h"
#include "quell/image/stream.h"
#include "quell/metrics/comparison.h"

namespace quell::app {

struct MeasuringOptions {
  ImageSeries reference;
  std::optional<ImageSeries> motion;           ///< for Metric::warped
  std::set<std::string, std::less<>> outputs;  ///< to be measured: color images
  std::vector<std::int64_t> frames;            ///< of the run, ascending
  CompareOptions compare;

  /// Of a run of one frame, a single file is the reference whatever its number.
  bool has_reference(std::int64_t frame) const { return reference.has(frame) || (reference.is_single() && frames.size() == 1); }
};

/// Figures of one output.
struct MeasuredOutput {
  std::string output;
  std::vector<Score> scores;  ///< of each metric
  std::uint64_t bad_pixels = 0, bad_pixels_in_reference = 0;
};

/// Hands everything on to another sink, and then measures color outputs on the same thread, so that as many frames are measured
/// at a time as are written. For temporal metrics, images are copied, and kept until the frame after theirs was taken. What is
/// written does not depend on it: a frame that cannot be measured is told in a warning, and has no figures. Temporal metrics are
/// about frames that both ended well. Figures are the same in whatever order frames are written. Thread-safe, as long as the
/// outputs of one frame are written one after the other.
class MeasuringSink final : public FrameSink {
 public:
  /// The other sink must outlive this one.
  MeasuringSink(FrameSink& sink, MeasuringOptions options);
  ~MeasuringSink() override;

  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return true; }

  /// Of a frame that ended well, when all before it ended, too: what was measured, by output's name. Ascending.
  std::vector<MeasuredOutput> take(std::int64_t frame);
  /// Of a frame that failed.
  void forget(std::int64_t frame);
  /// All frames are written again. Not while one is.
  void restart();
  /// The sums of what was taken, by output's name.
  std::vector<MeasuredOutput> totals() const;
  /// The frames that were taken and have figures.
  std::vector<std::int64_t> measured_frames() const;

  const MeasuringOptions& options() const { return options_; }

 private:
  struct State;
  void measure(const std::string& output, std::int64_t frame, const Image& image);
  Image read_reference(std::int64_t frame);
  void measure_changes(const std::string& output, std::int64_t frame);
  Image read_motion(std::int64_t frame, Size size);
  FrameSink& sink_;
  const MeasuringOptions options_;
  std::unique_ptr<State> state_;
};

}  // namespace quell::app
