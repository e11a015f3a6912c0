#include "comparison_run.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <future>
#include <mutex>
#include <utility>

#include "metric_options.h"
#include "quell/runtime/sanitize.h"
#include "quell/text/error.h"

namespace quell::app {
namespace {

using Clock = std::chrono::steady_clock;

/// What is read of a frame.
struct ReadFrame {
  Image reference;
  std::vector<Image> images;
  Image motion;       // none where it is not wanted, or has no file
  std::string error;  // why something could not be read; "" when all was
};

/// A thread that keeps a processor busy, beside the executor's helpers.
class BudgetShare {
 public:
  explicit BudgetShare(Executor& executor) : budget_(executor.budget()) { budget_.take(); }
  ~BudgetShare() { budget_.give_back(); }
  BudgetShare(const BudgetShare&) = delete;
  BudgetShare& operator=(const BudgetShare&) = delete;

 private:
  ThreadBudget& budget_;
};

std::string size_text(const Image& image) { return std::to_string(image.width()) + " x " + std::to_string(image.height()); }

class Reader {
 public:
  Reader(const ComparisonJob& job, Executor& executor, BufferPool& pool) : job_(job), executor_(executor), pool_(pool) {}

  /// The frame at this place of the job, decoded side by side.
  ReadFrame read(std::size_t index) const {
    const std::int64_t frame = job_.frames[index];
    const bool wants_motion =
        job_.motion && contains(job_.options.metrics, Metric::warped) && has_previous(index) && job_.motion->has(frame);
    ReadFrame result;
    result.images.resize(job_.images.size());
    try {
      run_on(executor_)(static_cast<int>(job_.images.size()) + 2, [&](int i) {
        if (i == 0) result.reference = job_.reference.read(frame, pool_);
        if (i == 1 && wants_motion) result.motion = job_.motion->read(frame, pool_);
        if (i >= 2) {
          const auto at = static_cast<std::size_t>(i - 2);
          result.images[at] = job_.images[at].read(frame, pool_);
        }
      });
      require_one_size(result, frame);
    } catch (const std::bad_alloc&) { result.error = "memory ran out"; } catch (const Error& error) {
      result.error = error.what();
    }
    return result;
  }

  bool has_previous(std::size_t index) const { return index > 0 && job_.frames[index] - 1 == job_.frames[index - 1]; }

 private:
  void require_one_size(const ReadFrame& read, std::int64_t frame) const {
    const auto require = [&](const ImageSeries& series, const Image& image) {
      if (!image || (image.width() == read.reference.width() && image.height() == read.reference.height())) return;
      throw Error(Fault::input, series.file(frame).string(),
                  "has " + size_text(image) + " pixels, but " + job_.reference.file(frame).string() + " has " +
                      size_text(read.reference));
    };
    for (std::size_t i = 0; i < job_.images.size(); ++i) require(job_.images[i], read.images[i]);
    if (job_.motion) require(*job_.motion, read.motion);
  }

  const ComparisonJob& job_;
  Executor& executor_;
  BufferPool& pool_;
};

/// One frame after the other; keeps the images of the one before.
class Comparison {
 public:
  Comparison(const ComparisonJob& job, Executor& executor) : job_(job), parallel_(run_on(executor)) {}

  ComparedFrame compare_next(std::size_t index, ReadFrame read, bool follows, FramePictures& pictures, BufferPool& pool) {
    ComparedFrame result;
    result.frame = job_.frames[index];
    result.error = read.error;
    result.has_previous = follows && previous_ && previous_->reference.size() == read.reference.size();
    result.lacks_motion = result.has_previous && job_.motion && !read.motion && contains(job_.options.metrics, Metric::warped);
    try {
      if (result.error.empty()) compare_images(read, result, pictures, pool);
    } catch (const std::bad_alloc&) { result.error = "memory ran out"; } catch (const Error& error) {
      result.error = error.what();
    }
    if (!result.error.empty()) {
      result.images.clear();
      result.lacks_motion = false;  // it failed for another reason
    }
    previous_ = result.error.empty() ? std::optional(std::move(read)) : std::nullopt;
    return result;
  }

 private:
  void compare_images(const ReadFrame& read, ComparedFrame& result, FramePictures& pictures, BufferPool& pool) const {
    pictures = {result.frame, read.reference, read.images, {}, {}};
    for (std::size_t i = 0; i < read.images.size(); ++i) {
      CompareInput input{{read.reference, read.images[i]}};
      if (result.has_previous) input.previous = ImagePair{previous_->reference, previous_->images[i]};
      input.motion = read.motion;
      FrameScores scores = compare(input, job_.options, job_.want_maps, pool, parallel_);
      if (result.lacks_motion) forget_warped(scores.scores);
      result.images.push_back({std::move(scores.scores), scores.bad_in_image});
      result.bad_pixels_in_reference = scores.bad_in_reference;
      pictures.flip_maps.push_back(std::move(scores.flip_map));
      pictures.hdr_flip_maps.push_back(std::move(scores.hdr_flip_map));
    }
  }

  /// Figures with motion and without it must not be mixed.
  void forget_warped(std::vector<Score>& scores) const {
    for (std::size_t i = 0; i < scores.size(); ++i)
      if (job_.options.metrics[i] == Metric::warped) scores[i] = {};
  }

  const ComparisonJob& job_;
  Parallel parallel_;
  std::optional<ReadFrame> previous_;
};

}  // namespace

Parallel run_on(Executor& executor) {
  return [&executor](int count, const std::function<void(int)>& body) {
    std::mutex mutex;
    std::exception_ptr first;
    int first_at = count;
    executor.run(count, [&](std::int64_t i, std::uint32_t) {
      try {
        body(static_cast<int>(i));
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (i < first_at) first = std::current_exception(), first_at = static_cast<int>(i);
      }
    });
    if (first) std::rethrow_exception(first);
  };
}

std::vector<ComparedFrame> run_comparison(const ComparisonJob& job, Executor& executor, const ComparisonHooks& hooks) {
  BufferPool pool;
  const Reader reader(job, executor, pool);
  const BudgetShare own_share(executor);
  const bool is_alone = executor.slots() == 1;  // then a frame is read when it is wanted, by this thread
  const auto read_ahead = [&](std::size_t index) {
    return std::async(is_alone ? std::launch::deferred : std::launch::async, [&reader, &executor, index, is_alone] {
      const auto share = is_alone ? nullptr : std::make_unique<BudgetShare>(executor);
      return reader.read(index);
    });
  };
  Comparison comparison(job, executor);
  std::vector<ComparedFrame> frames;
  std::future<ReadFrame> next = read_ahead(0);
  for (std::size_t i = 0; i < job.frames.size() && !hooks.cancelled(); ++i) {
    const Clock::time_point start = Clock::now();
    ReadFrame read = next.get();
    if (i + 1 < job.frames.size()) next = read_ahead(i + 1);
    FramePictures pictures;
    frames.push_back(comparison.compare_next(i, std::move(read), reader.has_previous(i), pictures, pool));
    frames.back().seconds = std::chrono::duration<double>(Clock::now() - start).count();
    hooks.on_frame(frames.back(), frames.back().error.empty() ? &pictures : nullptr);
  }
  return frames;
}

std::optional<Exposures> find_exposures(const ImageSeries& reference, const std::vector<std::int64_t>& frames, Executor& executor,
                                        const std::function<bool()>& cancelled,
                                        const std::function<void(std::size_t)>& progress) {
  BufferPool pool;
  std::vector<LuminanceRange> ranges;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (cancelled()) return std::nullopt;
    progress(i);
    try {
      Item image = reference.read(frames[i], pool);
      sanitize(image, executor, pool);
      ranges.push_back(luminance_range(image.image()->floats(), pool, run_on(executor)));
    } catch (const Error&) {}  // told when the frame is to be compared
  }
  return choose_exposures(ranges);
}

std::vector<ImageFigures> add_up(const std::vector<ComparedFrame>& frames, std::size_t images, std::size_t metrics) {
  std::vector<ImageFigures> sums(images, {std::vector<Score>(metrics), 0});
  for (const ComparedFrame& frame : frames)
    for (std::size_t i = 0; i < frame.images.size(); ++i) {
      for (std::size_t m = 0; m < metrics; ++m) sums[i].scores[m] += frame.images[i].scores[m];
      sums[i].bad_pixels += frame.images[i].bad_pixels;
    }
  return sums;
}

}  // namespace quell::app
