#include "measuring_sink.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <new>
#include <utility>

#include "console.h"
#include "metric_options.h"

namespace quell::app {
namespace {

/// A frame's images and what is known of them, by output.
struct KeptFrame {
  Image reference;
  std::map<std::string, Image> images;  // copies, for temporal metrics
  std::map<std::string, MeasuredOutput> measured;
};

/// The metrics of one kind; the others are told by another comparison.
CompareOptions select(const CompareOptions& options, bool temporal) {
  CompareOptions selected = options;
  std::erase_if(selected.metrics, [&](Metric metric) { return info(metric).is_temporal != temporal; });
  return selected;
}

Image copy(const Image& image, BufferPool& pool) {
  Image result(image.type(), image.size(), pool);
  const FloatImage from = image.floats();
  const FloatOutput to = result.writable_floats();
  for (int c = 0; c < from.channels; ++c)
    for (int y = 0; y < from.height; ++y) std::copy_n(from.row(y, c), from.width, to.row(y, c));
  return result;
}

/// What goes wrong is told; it must not fail the frame, which is written.
void guarded(std::int64_t frame, std::string_view figures, std::string_view output, const std::function<void()>& body) {
  try {
    body();
  } catch (const std::bad_alloc&) {
    spdlog::warn("frame {}: no {} of {}: memory ran out", frame, figures, output);
  } catch (const std::exception& error) { spdlog::warn("frame {}: no {} of {}: {}", frame, figures, output, error.what()); }
}

std::string size_text(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels"; }

}  // namespace

struct MeasuringSink::State {
  BufferPool pool;
  CompareOptions still, temporal;
  mutable std::mutex mutex;  // guards what follows
  std::map<std::int64_t, KeptFrame> frames;
  std::set<std::pair<std::string, std::int64_t>> claimed;  // outputs whose change from the frame before somebody measures
  std::set<std::string> told;
  std::map<std::string, MeasuredOutput> totals;
  std::vector<std::int64_t> measured;
  std::optional<std::int64_t> last_taken;

  void put(const std::string& output, std::int64_t frame, const std::vector<Metric>& all, const std::vector<Metric>& some,
           const FrameScores& scores) {
    const std::lock_guard lock(mutex);
    MeasuredOutput& measured_output = frames[frame].measured[output];
    measured_output.output = output;
    measured_output.scores.resize(all.size());
    for (std::size_t i = 0; i < some.size(); ++i)
      measured_output.scores[static_cast<std::size_t>(std::ranges::find(all, some[i]) - all.begin())] = scores.scores[i];
    measured_output.bad_pixels = scores.bad_in_image;
    measured_output.bad_pixels_in_reference = scores.bad_in_reference;
  }

  /// The pairs of two frames that both are there, for the one who asks first; nothing else.
  std::optional<CompareInput> claim(const std::string& output, std::int64_t frame) {
    const std::lock_guard lock(mutex);
    const auto now = frames.find(frame), before = frames.find(frame - 1);
    if (now == frames.end() || before == frames.end()) return std::nullopt;
    const auto image = now->second.images.find(output), image_before = before->second.images.find(output);
    if (image == now->second.images.end() || image_before == before->second.images.end()) return std::nullopt;
    if (image->second.size() != image_before->second.size() || !claimed.emplace(output, frame).second) return std::nullopt;
    CompareInput input{{now->second.reference, image->second}};
    input.previous = ImagePair{before->second.reference, image_before->second};
    return input;
  }

  void tell_once(const std::string& text) {
    {
      const std::lock_guard lock(mutex);
      if (!told.insert(text).second) return;
    }
    spdlog::warn(text);
  }

  /// After a frame that failed when its image was measured already: which of the two was written first must not matter.
  void forget_changes(const std::vector<Metric>& all, MeasuredOutput& output) const {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (info(all[i]).is_temporal) output.scores[i] = {};
  }
};

MeasuringSink::MeasuringSink(FrameSink& sink, MeasuringOptions options)
    : sink_(sink), options_(std::move(options)), state_(std::make_unique<State>()) {
  state_->still = select(options_.compare, false);
  state_->temporal = select(options_.compare, true);
}

MeasuringSink::~MeasuringSink() = default;

void MeasuringSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  sink_.write(output, frame, item);
  const Image* image = item.image();
  if (!image || !options_.outputs.contains(output) || !options_.has_reference(frame)) return;
  guarded(frame, "figures", output, [&] { measure(std::string(output), frame, *image); });
}

/// Once a frame, whatever the number of outputs.
Image MeasuringSink::read_reference(std::int64_t frame) {
  {
    const std::lock_guard lock(state_->mutex);
    if (const KeptFrame& kept = state_->frames[frame]; kept.reference) return kept.reference;
  }
  Image reference = options_.reference.read(frame, state_->pool);
  const std::lock_guard lock(state_->mutex);
  return state_->frames[frame].reference = std::move(reference);
}

void MeasuringSink::measure(const std::string& output, std::int64_t frame, const Image& image) {
  const Image reference = read_reference(frame);
  if (image.size() != reference.size())
    return state_->tell_once("no figures of " + output + ", which has " + size_text(image.size()) + ", while " +
                             options_.reference.files() + " has " + size_text(reference.size()));
  const ImagePair pair{reference, image.as(QUELL_TYPE_COLOR)};
  state_->put(output, frame, options_.compare.metrics, state_->still.metrics,
              compare({pair}, state_->still, false, state_->pool));
  if (state_->temporal.metrics.empty()) return;
  const auto& frames = options_.frames;
  const bool has_neighbor = std::ranges::binary_search(frames, frame - 1) || std::ranges::binary_search(frames, frame + 1);
  if (!has_neighbor) return;
  guarded(frame, "temporal figures", output, [&] {
    Image kept = copy(pair.image, state_->pool);
    {
      const std::lock_guard lock(state_->mutex);
      state_->frames[frame].images.insert_or_assign(output, std::move(kept));
    }
    measure_changes(output, frame);  // frames are written in any order: the later of two finds the other
  });
  guarded(frame + 1, "temporal figures", output, [&] { measure_changes(output, frame + 1); });
}

void MeasuringSink::measure_changes(const std::string& output, std::int64_t frame) {
  std::optional<CompareInput> input = state_->claim(output, frame);
  if (!input) return;
  CompareOptions options = state_->temporal;
  if (options_.motion && contains(options.metrics, Metric::warped)) {
    guarded(frame, info(Metric::warped).name, output, [&] { input->motion = read_motion(frame, input->pair.image.size()); });
    if (!input->motion) std::erase(options.metrics, Metric::warped);  // figures with motion and without it must not be mixed
  }
  state_->put(output, frame, options_.compare.metrics, options.metrics, compare(*input, options, false, state_->pool));
}

/// None where there is none, or of another size.
Image MeasuringSink::read_motion(std::int64_t frame, Size size) {
  if (!options_.motion->has(frame)) return {};
  Image motion = options_.motion->read(frame, state_->pool);
  if (motion.size() == size) return motion;
  state_->tell_once("no warped where " + options_.motion->files() + " has " + size_text(motion.size()) + ", and images have " +
                    size_text(size));
  return {};
}

std::vector<MeasuredOutput> MeasuringSink::take(std::int64_t frame) {
  const std::lock_guard lock(state_->mutex);
  const auto found = state_->frames.find(frame);
  std::vector<MeasuredOutput> result;
  if (found != state_->frames.end())
    for (auto& [output, measured] : found->second.measured) {
      if (state_->last_taken != frame - 1) state_->forget_changes(options_.compare.metrics, measured);
      MeasuredOutput& total = state_->totals[output];
      total.output = output;
      total.scores.resize(measured.scores.size());
      for (std::size_t i = 0; i < total.scores.size(); ++i) total.scores[i] += measured.scores[i];
      total.bad_pixels += measured.bad_pixels, total.bad_pixels_in_reference += measured.bad_pixels_in_reference;
      result.push_back(measured);
    }
  if (!result.empty()) state_->measured.push_back(frame);
  state_->last_taken = frame;
  std::erase_if(state_->claimed, [&](const auto& claim) { return claim.second <= frame; });
  state_->frames.erase(state_->frames.begin(), state_->frames.lower_bound(frame));  // this one is needed by the next
  return result;
}

void MeasuringSink::forget(std::int64_t frame) {
  const std::lock_guard lock(state_->mutex);
  state_->frames.erase(state_->frames.begin(), state_->frames.upper_bound(frame));
}

void MeasuringSink::restart() {
  const std::lock_guard lock(state_->mutex);
  state_->frames.clear();
  state_->claimed.clear();
  state_->totals.clear();
  state_->measured.clear();
  state_->last_taken.reset();
}

std::vector<MeasuredOutput> MeasuringSink::totals() const {
  const std::lock_guard lock(state_->mutex);
  std::vector<MeasuredOutput> result;
  for (const auto& [output, total] : state_->totals) result.push_back(total);
  return result;
}

std::vector<std::int64_t> MeasuringSink::measured_frames() const {
  const std::lock_guard lock(state_->mutex);
  return state_->measured;
}

}  // namespace quell::app
