#include "quell/metrics/comparison.h"

#include <algorithm>
#include <string>

#include "quell/metrics/bands.h"
#include "quell/metrics/flip_scores.h"
#include "quell/metrics/prepare.h"
#include "quell/metrics/ssim.h"
#include "quell/metrics/warped.h"
#include "quell/text/error.h"

namespace quell {
namespace {

using detail::Prepared;

std::string describe(const Image& image) {
  return std::string(name(image.type())) + " of " + std::to_string(image.width()) + " x " + std::to_string(image.height());
}

void require_color(const Image& image, const char* what) {
  if (!image) throw Error(Fault::input, "", std::string("there is no ") + what + " to compare");
  if (image.type() == QUELL_TYPE_COLOR) return;
  throw Error(Fault::input, "", std::string("the ") + what + " is " + describe(image) + "; metrics compare color");
}

void require_size(const Image& image, const char* what, const Image& reference) {
  if (image.size() == reference.size()) return;
  throw Error(Fault::input, "",
              std::string("the ") + what + " is " + describe(image) + ", the reference " + describe(reference) +
                  "; both must have one size");
}

void check(const CompareInput& input) {
  const Image& reference = input.pair.reference;
  require_color(reference, "reference");
  require_color(input.pair.image, "image");
  require_size(input.pair.image, "image", reference);
  if (input.previous) {
    require_color(input.previous->reference, "reference of the frame before");
    require_color(input.previous->image, "image of the frame before");
    require_size(input.previous->reference, "reference of the frame before", reference);
    require_size(input.previous->image, "image of the frame before", reference);
  }
  if (!input.motion) return;
  if (input.motion.type() != QUELL_TYPE_MOTION)
    throw Error(Fault::input, "", "the motion is " + describe(input.motion) + "; motion of two planes is needed");
  require_size(input.motion, "motion", reference);
}

// One comparison: what the metrics look at, and what they add up.
class Comparison {
 public:
  Comparison(const CompareInput& input, const CompareOptions& options, bool want_maps, BufferPool& pool, const Parallel& parallel)
      : input_(input), options_(options), want_maps_(want_maps), pool_(pool), parallel_(parallel) {
    const bool radiance = wants(Metric::relmse) || wants(Metric::smape) || wants(Metric::hdr_flip);
    now_ = detail::prepare(input.pair, options.display, radiance, pool, parallel);
    if (input.previous && (wants(Metric::tpsnr) || wants(Metric::warped)))
      before_ = detail::prepare(*input.previous, options.display, false, pool, parallel);
  }

  FrameScores run() {
    FrameScores result;
    if (want_maps_ && wants(Metric::flip)) result.flip_map = make_map();
    if (want_maps_ && wants(Metric::hdr_flip)) result.hdr_flip_map = make_map();
    for (const Metric metric : options_.metrics) result.scores.push_back(score(metric, result));
    result.bad_in_reference = now_.bad.in_reference;
    result.bad_in_image = now_.bad.in_image;
    return result;
  }

 private:
  bool wants(Metric metric) const { return std::ranges::count(options_.metrics, metric) > 0; }

  Score score(Metric metric, FrameScores& result) {
    switch (metric) {
      case Metric::psnr:
      case Metric::mse:
        return sum_rows(detail::squared_errors, now_.shown_reference, now_.shown_image);
      case Metric::relmse:
        return sum_rows(detail::relative_squared_errors, now_.reference, now_.image);
      case Metric::smape:
        return sum_rows(detail::symmetric_errors, now_.reference, now_.image);
      case Metric::ssim:
        return detail::ssim(now_.shown(), parallel_);
      case Metric::tpsnr:
        return before_ ? sum_changes() : Score{};
      case Metric::warped:
        return before_ ? warped() : Score{};
      case Metric::flip:
        return detail::flip_of_display(now_, options_, writable(result.flip_map), pool_, parallel_);
      case Metric::hdr_flip:
        return detail::flip_of_radiance(now_, options_, writable(result.hdr_flip_map), pool_, parallel_);
    }
    return {};
  }

  Image make_map() const { return {QUELL_TYPE_SCALAR, input_.pair.reference.size(), pool_}; }
  static FloatOutput writable(Image& map) { return map ? map.writable_floats() : FloatOutput{}; }

  Score sum_rows(double (*row)(FloatImage reference, FloatImage image, int y), const Image& reference, const Image& image) const {
    const FloatImage r = reference.floats(), a = image.floats();
    Score score = detail::sum_bands<Score>(r.height, parallel_, [&](int y0, int y1) {
      Score band;
      for (int y = y0; y < y1; ++y) band.sum += row(r, a, y);
      return band;
    });
    score.count = now_.good;
    return score;
  }

  Score sum_changes() const {
    const detail::Shown now = now_.shown(), before = before_->shown();
    return detail::sum_bands<Score>(now.counts.height, parallel_, [&](int y0, int y1) {
      Score band;
      for (int y = y0; y < y1; ++y) band += detail::squared_change_errors(now, before, y);
      return band;
    });
  }

  Score warped() const {
    const FloatImage motion = input_.motion ? input_.motion.floats() : FloatImage{};
    return detail::warped_errors(now_.shown(), before_->shown(), motion, parallel_);
  }

  const CompareInput& input_;
  const CompareOptions& options_;
  const bool want_maps_;
  BufferPool& pool_;
  const Parallel& parallel_;
  Prepared now_;
  std::optional<Prepared> before_;
};

}  // namespace

FrameScores compare(const CompareInput& input, const CompareOptions& options, bool want_maps, BufferPool& pool,
                    const Parallel& parallel) {
  check(input);
  return Comparison(input, options, want_maps, pool, parallel).run();
}

}  // namespace quell
