#include "report_images.h"

#include "quell/metrics/comparison.h"
#include "quell/text/error.h"

namespace quell::app {

ReportSink::ReportSink(const ReportFrames& frames, Names results, Weighed weighed, Reference reference, PackedImages& packed)
    : frames_(frames), results_(std::move(results)), weighed_(std::move(weighed)), reference_(reference), packed_(packed) {}

void ReportSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  const Image* image = item.image();
  const bool is_result = results_.contains(output);
  const bool is_inner = frames_.inner.contains(frame), is_shown = is_result && frames_.kept.contains(frame);
  const bool is_exact =
      (is_inner && weighed_.now.contains(output)) || (frames_.before.contains(frame) && weighed_.before.contains(output));
  if (!image || !(is_inner || is_exact || is_shown)) return;
  const int number = packed_.add(pack(*image, is_exact ? Precision::exact : Precision::shown));
  const bool has_map = is_shown && image->type() == QUELL_TYPE_COLOR && reference_.series &&
                       (reference_.is_for_all || reference_.series->has(frame));
  const int map = has_map ? make_map(frame, *image) : -1;
  const std::lock_guard lock(mutex_);
  ReportImage& series = images_[std::string(output)];
  series.name = output, series.type = image->type();
  series.kind = is_result ? ReportImage::Kind::result : ReportImage::Kind::inner;
  series.frames[frame] = number;
  if (map >= 0) series.flip[frame] = map;
}

/// -1 when the reference cannot be read, or has another size: whoever measures says so.
int ReportSink::make_map(std::int64_t frame, const Image& image) {
  Image reference;
  try {
    reference = reference_.series->read(frame, pool_);
  } catch (const Error&) { return -1; }
  if (reference.size() != image.size()) return -1;
  const CompareOptions options{.metrics = {Metric::flip}, .display = reference_.display};
  return packed_.add(pack_map(compare({{reference, image}}, options, true, pool_).flip_map));
}

void ReportSink::forget(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  for (auto& [name, image] : images_) image.frames.erase(frame), image.flip.erase(frame);
}

}  // namespace quell::app
