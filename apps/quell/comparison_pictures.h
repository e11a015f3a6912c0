// Pictures of errors, in FLIP's colors.
#pragma once

#include <filesystem>
#include <optional>

#include "comparison_run.h"

namespace quell::app {

/// The errors of each pixel, unscaled.
class ErrorMaps {
 public:
  /// Makes the folder. Throws Error(usage) naming --maps when that fails, or a map would replace a file that is compared.
  ErrorMaps(const std::filesystem::path& folder, const ComparisonJob& job);
  /// Writes FOLDER/LABEL.flip.####.png, or hdrflip, of each image, on the executor's threads. Throws Error(frame).
  void write(const FramePictures& pictures, Executor& executor) const;

 private:
  std::filesystem::path file(std::size_t image, const char* metric, std::int64_t frame) const;
  std::filesystem::path folder_;
  const ComparisonJob& job_;
  int padding_;
};

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

/// Throws Error(usage) naming the option when the file is one that is compared.
void refuse_to_replace_images(const std::filesystem::path& file, const ComparisonJob& job, const char* option);

}  // namespace quell::app
