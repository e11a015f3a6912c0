// Video of an output, made by the program ffmpeg.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "quell/graph/plan.h"
#include "quell/image/stream.h"

namespace quell::app {

/// Whether a name ends as a video's: .mp4, .mov, .mkv or .webm, in small or capital letters.
bool is_video(const std::filesystem::path& file);
/// Throws Error(usage) naming --out when a folder, or whatever is no file, stands there.
void check_video_file(const std::filesystem::path& file);

struct VideoOptions {
  std::filesystem::path file;
  std::string output;  ///< of the graph: color
  Size size;
  double frames_per_second = 24;
};

/// The output that a video shows: `color`, else the only one of type color. Throws Error(usage) naming --out.
PlannedResult find_video_output(const Plan& plan);

/// Hands frames to ffmpeg, found in PATH, in their order, whatever the order in which they are written; as PNG has them, 8 bit
/// with the sRGB curve, clamped to 0..1. The file takes its name when it is complete. Writing is thread-safe.
class VideoSink final : public FrameSink {
 public:
  /// Starts ffmpeg. Throws Error(usage) naming --out when there is none.
  explicit VideoSink(VideoOptions options);
  ~VideoSink() override;

  void write(std::string_view output, std::int64_t frame, const Item& item) override;
  bool uses_processor() const override { return true; }

  /// In the order of frames, for each of them. A frame that failed shows the one before it, or, where there is none, the first
  /// that did not, so that the others keep their time.
  void end_frame(std::int64_t frame, bool ok);
  /// After the last. Throws Error(frame), with the words of ffmpeg, when it fails; nothing is left behind then, nor where there
  /// was no frame.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quell::app
