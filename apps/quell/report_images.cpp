#include "report_images.h"

namespace quell::app {

ReportSink::ReportSink(const ReportFrames& frames, Names results, Weighed weighed, PackedImages& packed)
    : frames_(frames), results_(std::move(results)), weighed_(std::move(weighed)), packed_(packed) {}

void ReportSink::write(std::string_view output, std::int64_t frame, const Item& item) {
  const Image* image = item.image();
  const bool is_result = results_.contains(output), is_inner = frames_.inner.contains(frame);
  const bool is_exact =
      (is_inner && weighed_.now.contains(output)) || (frames_.before.contains(frame) && weighed_.before.contains(output));
  if (!image || !(is_inner || is_exact || (is_result && frames_.kept.contains(frame)))) return;
  const int number = packed_.add(pack(*image, is_exact ? Precision::exact : Precision::shown));
  const std::lock_guard lock(mutex_);
  ReportImage& series = images_[std::string(output)];
  series.name = output, series.type = image->type();
  series.kind = is_result ? ReportImage::Kind::result : ReportImage::Kind::inner;
  series.frames[frame] = number;
}

void ReportSink::forget(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  for (auto& [name, image] : images_) image.frames.erase(frame);
}

}  // namespace quell::app
