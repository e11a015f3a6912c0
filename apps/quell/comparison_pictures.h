// Pictures of errors, in FLIP's colors.
#pragma once

#include <filesystem>
#include <optional>

#include "comparison_run.h"

namespace quell::app {

/// The files of all maps: FOLDER/LABEL.flip.####.png and hdrflip, of those that are among the metrics.
std::vector<std::filesystem::path> list_maps(const std::filesystem::path& folder, const ComparisonJob& job);
/// Writes those of one frame, the errors of each pixel, unscaled, on the executor's threads. Throws Error(frame).
void write_maps(const std::filesystem::path& folder, const ComparisonJob& job, const FramePictures& pictures, Executor& executor);

/// Keeps the images of the frame in which an image has the largest error by FLIP (else HDR-FLIP), of equal ones the first.
class WorstFrame {
 public:
  explicit WorstFrame(const ComparisonJob& job) : job_(job) {}
  void look_at(const ComparedFrame& frame, const FramePictures& pictures);
  /// The reference, the images and their errors, with all figures. False when no font was found; nothing when no frame was
  /// compared. Throws Error(frame).
  std::optional<bool> draw(const std::filesystem::path& file) const;

 private:
  /// Half of them has room below a picture.
  std::string figures(std::size_t image, bool first_half) const;
  const ComparisonJob& job_;
  double error_ = -1;
  ComparedFrame frame_;
  FramePictures pictures_;
};

}  // namespace quell::app
